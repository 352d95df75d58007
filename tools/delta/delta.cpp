// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/delta/delta_file.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/progress.h"
#include "base/text.h"
#include "conversion/read_grids.h"
#include "conversion/run_conversion.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/list_grids.h"
#include "files/file_name.h"
#include "formats/delta/delta_format.h"
#include "options/input_options.h"
#include "options/parse.h"
#include "process/print_out.h"
#include "subcommands.h"

namespace deltasplat {
namespace {

// What its leaf of deltas and the list of blocks takes for an 8x8x8 block that is not uniform.
constexpr double kBytesPerBlock = 2300;
// What measuring the error takes besides, of values of 4 bytes: what comes back, as codes and as
// values.
constexpr double kBytesPerInexactBlock = 4500;
// A tolerance takes a second tree of codes and measures as well.
constexpr double kBytesPerHeldBlock = 1200 + kBytesPerInexactBlock;

// What packed deltas take beside those that they are packed from: most bits of noise, twice.
constexpr double kBytesPerPackedBlock = 1600;
// And of values by their own bits, up to 64 of them.
constexpr double kBytesPerPackedInexactBlock = 1200;

// Share of the progress up to writing.
constexpr double kTakeShare = 0.8;

struct DeltaCommand {
    ConversionFiles files;
    FrameChoice frames;
    ReadOptions read;
    DeltaFileOptions file;
    std::optional<bool> packs;
    bool scalarsAlone = false;  // others may be lost
};

Parser<std::optional<int>> sliceAxis() {
    return [](const std::string& option, const std::string& text) -> std::optional<int> {
        const std::string name = choice({"auto", "x", "y", "z"})(option, text);
        return name == "auto" ? std::nullopt : std::optional<int>(name[0] - 'x');
    };
}

Parser<int> keyInterval() {
    return [](const std::string& option, const std::string& text) {
        const int slices = int(wholeNumber(0, 1 << 20)(option, text));
        if (slices % 8 == 0) return slices;
        throw Error(ErrorCode::kUsage, option, text, "a multiple of 8");
    };
}

void declareOptions(CLI::App& app, DeltaCommand& command) {
    OptionGroup arguments(app, "Arguments");
    arguments
        .addValue("INPUT", "FILE", command.files.input, anyText(),
                  "Volume to read, in any format that render reads; of a .vdb\n"
                  "every scalar grid")
        .required();
    arguments
        .addValue("OUTPUT", "FILE.vdb", command.files.output, anyText(), "Delta grids to write")
        .required();

    OptionGroup deltas(app, "Delta grids");
    deltas.addValue("--axis", "auto|x|y|z", command.file.sliceAxis, sliceAxis(),
                    withDefault("Axis along which slices are compared; auto: the one with\n"
                                "the fewest deltas",
                                "auto"));
    deltas.addValue("--key-interval", "N", command.file.keyInterval, keyInterval(),
                    withDefault("Slices from one key slice to the next, a multiple of 8;\n"
                                "0: a sixteenth of the volume, at least 128",
                                std::to_string(command.file.keyInterval)));
    deltas.addValue("--bits", "N", command.read.bits, wholeNumber(8, 16),
                    "Store real values in 2^N even steps, 8..16 (default: exactly)");
    deltas.addFlag("--codes", command.file.codesOnly,
                   "Store values of which there are more than 65536 different ones\n"
                   "as the codes that pictures are made of, within 2e-4 of\n"
                   "themselves as a rule: smaller, and not lossless");
    deltas.addValue("--max-error", "E", command.file.maxError, number(0),
                    "Fail, and write nothing, if a value would come back with a\n"
                    "larger error than E data units");
    deltas.addFlag("--scalars-only", command.scalarsAlone,
                   "Leave out grids that are not scalar, as vectors and points are,\n"
                   "with a warning (default: a file with such grids fails, and\n"
                   "nothing is written)");
    deltas.addValue("--tolerance", "T", command.file.tolerance.relative, number(0, 1),
                    withDefault("Keep a voxel's value while the true one stays within T times\n"
                                "its magnitude",
                                numberText(command.file.tolerance.relative)));
    deltas.addValue("--tolerance-value", "V", command.file.tolerance.value, number(0),
                    withDefault("Keep a voxel's value while the true one stays within V data\n"
                                "units",
                                numberText(command.file.tolerance.value)));
    deltas.addSwitch("--pack", "--no-pack", command.packs,
                     "Store deltas as a stream of bits (default), or each as a voxel, which\n"
                     "other programs see: mostly twice the bytes, and read more slowly");
    addConversionOptions(app, "sizes, deltas, largest error, seconds", command.files,
                         command.frames);
    addInputOptions(app, command.read);
}

void checkDeltaFile(const std::filesystem::path& output) {
    if (lowerExtension(output) != ".vdb") {
        throw Error(ErrorCode::kUsage, output.string(),
                    "extension \"" + output.extension().string() + "\"", ".vdb");
    }
    const AtomicFile probe(output);
}

void add(const DeltaFileEntry& entry, ConversionStats& stats) {
    stats.deltas += entry.deltas;
    stats.maxError = std::max(stats.maxError, entry.maxError);
    stats.lossless = stats.lossless && entry.lossless;
}

bool isWhole(const std::string& type) {
    return type.rfind("int", 0) == 0 || type.rfind("uint", 0) == 0 || type == "bool" ||
           type == "mask";
}

// Labels are whole numbers, and a label that is rounded is another one.
void warnOfWholeNumbers(const Volume& volume, const DeltaFileEntry& entry,
                        const DeltaCommand& command, const Listener& listener) {
    if (!isWhole(volume.type()) || isOfCodes(volume)) return;
    if (command.read.bits) listener.warn("--bits: has no effect on whole numbers");
    if (entry.lossless || !command.file.tolerance.isExact() || entry.maxError == 0) return;
    if (volume.readError() > 0) return;  // has been said
    const std::string why = command.file.codesOnly ? "more than 65536 different values of type "
                                                   : "some of the 65537 largest values of type ";
    listener.warn("grid \"" + volume.name() + "\": " + why + volume.type() +
                  ", which are rounded by up to " + numberText(entry.maxError) +
                  " (--max-error 0 refuses)");
}

[[noreturn]] void refuseOthers(const std::filesystem::path& input, const std::string& others) {
    throw Error(ErrorCode::kFailed, input.string(), others + ", which no delta grid holds",
                "scalar grids alone (--scalars-only leaves out others)");
}

// Asked before hours of work, as far as it can be known.
void requireScalars(const DeltaCommand& command, const std::filesystem::path& input) {
    const bool mayHoldOthers = isVdbName(input) && !command.read.gridName;
    if (command.scalarsAlone || !mayHoldOthers) return;
    const GridList grids = listGrids(input);
    if (!grids.scalar.empty() && !grids.others.empty()) refuseOthers(input, nameList(grids.others));
}

ConversionStats takeDeltas(const CLI::App& app, const DeltaCommand& command,
                           const ConversionFiles& files, const Listener& listener) {
    ReadOptions reading = command.read;
    // Half of what may be lost goes to the code book, where one is needed, the rest to holding.
    const double relative = command.file.tolerance.relative;
    if (relative > 0) reading.relativeError = relative / 2;
    if (!command.file.tolerance.isExact()) reading.bytesPerBlock += kBytesPerHeldBlock;
    const bool packs = command.packs.value_or(command.file.pack);
    if (packs) {
        reading.bytesPerBlock += kBytesPerPackedBlock;
        reading.bytesPerInexactBlock += kBytesPerPackedInexactBlock;
    }
    warnOfUnusedInputOptions(app, {files.input}, listener);
    requireScalars(command, files.input);
    ConversionStats stats;
    DeltaFile file;
    Listener remarks;
    remarks.warning = listener.warning;
    const std::string others = forEachScalarGrid(
        files.input, reading,
        [&](const Volume& volume) {
            if (isOfCodes(volume) && reading.bits)
                remarks.warn("--bits: has no effect on deltas of codes, which keep their book");
            DeltaFileOptions writing = command.file;
            writing.pack = packs;
            if (reading.bits && !isWhole(volume.type())) writing.codesOnly = true;
            const DeltaFileEntry entry = file.add(volume, writing, remarks);
            stats.add(volume, entry.codeBook);
            warnOfWholeNumbers(volume, entry, command, remarks);
            add(entry, stats);
        },
        partOf(listener, 0, kTakeShare));
    if (!command.scalarsAlone && !others.empty()) refuseOthers(files.input, others);
    file.write(files.output);
    listener.report(1);
    stats.outputBytes = bytesOf({files.output});
    stats.lossless = stats.lossless && others.empty();
    return stats;
}

void runDelta(const CLI::App& app, const DeltaCommand& command, const Session& session) {
    checkFirstOutput(command.files, command.frames, checkDeltaFile);
    const ConversionStats stats =
        runConversion(app, command.files, command.frames, session,
                      [&](const ConversionFiles& files, const Listener& listener) {
                          return takeDeltas(app, command, files, listener);
                      });
    if (stats.maxError > 0 && !session.common.quiet)
        printOut("largest error " + numberText(stats.maxError) + "\n");
}

}  // namespace

Subcommand addDelta(CLI::App& program) {
    const auto command = std::make_shared<DeltaCommand>();
    // What is in a file is kept as it is, not as it would be rendered.
    command->read.levelSetToFog = false;
    command->read.keepSource = true;
    command->read.bytesPerBlock = kBytesPerBlock;
    command->read.bytesPerInexactBlock = kBytesPerInexactBlock;
    CLI::App& app = addSubcommand(
        program, "delta", "Stores a volume as delta grids: what changes from slice to slice.",
        {"deltasplat delta smoke.vdb smoke_delta.vdb",
         "deltasplat delta head_256x256x225_uint8.raw.gz head.vdb --tolerance-value 2"});
    return {&app, [&app, command] { declareOptions(app, *command); },
            [&app, command](const Session& session) { runDelta(app, *command, session); }};
}

}  // namespace deltasplat
