// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/progress.h"
#include "base/text.h"
#include "conversion/run_conversion.h"
#include "deltasplat/convert/write_volume.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/list_grids.h"
#include "deltasplat/ingest/read_volume.h"
#include "formats/format.h"
#include "formats/input_files.h"
#include "formats/input_kind.h"
#include "options/input_options.h"
#include "subcommands.h"

namespace deltasplat {
namespace {

// Share of the progress that reading takes.
constexpr double kReadShare = 0.5;

struct RestoreCommand {
    ConversionFiles files;
    FrameChoice frames;
    ReadOptions read;
};

void declareOptions(CLI::App& app, RestoreCommand& command) {
    OptionGroup arguments(app, "Arguments");
    arguments.addValue("INPUT", "FILE.vdb", command.files.input, anyText(), "Delta grids to read")
        .required();
    arguments
        .addValue("OUTPUT", "FILE", command.files.output, anyText(),
                  "File to write: .vdb .npy .nrrd .nhdr .mhd .mha .nii .nii.gz\n"
                  ".raw or .raw.gz; a .vdb gets all delta grids, others the first")
        .required();
    OptionGroup options(app, "Restoring");
    addConfineOption(app);
    options.addValue("--grid", "NAME", command.read.gridName, anyText(),
                     "Grid to restore (default: all that the output can hold)");
    addConversionOptions(app, "sizes, deltas, largest error, seconds", command.files,
                         command.frames);
}

void requireVdb(const std::filesystem::path& input) {
    const InputKind kind = findInput(input, {});
    if (kind.is(vdbFormat())) return;
    if (inputsAreConfined()) requireConfined(input);
    throw Error(ErrorCode::kInput, input.string(), "another format",
                "a .vdb of delta grids (convert takes other "
                "formats)");
}

void requireDeltas(const std::filesystem::path& input, const Volume& volume) {
    if (volume.origin()) return;
    throw Error(ErrorCode::kInput, input.string() + ": grid \"" + volume.name() + "\"",
                "a grid of type " + volume.type(), "a delta grid (convert takes other grids)");
}

// The delta grids that the output can hold, by name. Without any, reading says what is wrong.
std::vector<std::optional<std::string>> chooseGrids(const RestoreCommand& command,
                                                    const std::filesystem::path& input,
                                                    const Listener& listener,
                                                    ConversionStats& stats) {
    requireVdb(input);
    if (command.read.gridName) return {command.read.gridName};
    GridList grids = listGrids(input);
    if (grids.deltas.empty()) {
        if (grids.scalar.empty()) return {std::nullopt};
        return {grids.scalar.front()};
    }
    const std::string where = input.string() + ": ";
    if (!grids.ordinary.empty()) {
        listener.warn(where + "left out " + nameList(grids.ordinary) +
                      ", which are no delta grids");
    }
    if (!command.files.toVdb() && grids.deltas.size() > 1) {
        listener.warn(where + "reading grid \"" + grids.deltas.front() + "\", the first of " +
                      std::to_string(grids.deltas.size()) + " delta grids");
        grids.deltas.resize(1);
    }
    stats.lossless = grids.ordinary.empty() || !command.files.toVdb();
    return {grids.deltas.begin(), grids.deltas.end()};
}

std::vector<Volume> readInput(const RestoreCommand& command, const std::filesystem::path& input,
                              const Listener& listener, ConversionStats& stats) {
    std::vector<Volume> volumes;
    const auto names = chooseGrids(command, input, listener, stats);
    for (const std::optional<std::string>& name : names) {
        const double done = double(volumes.size()) / double(names.size());
        ReadOptions options = command.read;
        options.gridName = name;
        Volume volume =
            readVolume(input, options, partOf(listener, done, done + 1 / double(names.size())));
        requireDeltas(input, volume);
        stats.add(volume, volume.origin()->codeBook);
        stats.deltas += volume.origin()->deltas;
        stats.maxError = std::max(stats.maxError, volume.origin()->maxError);
        // The source says all that the codes do, and more.
        if (volume.source()) volume = volume.withoutCodes();
        volumes.push_back(std::move(volume));
    }
    return volumes;
}

ConversionStats restoreFile(const RestoreCommand& command, const ConversionFiles& files,
                            const Listener& listener) {
    ConversionStats stats;
    std::vector<Volume> volumes =
        readInput(command, files.input, partOf(listener, 0, kReadShare), stats);
    WriteOptions writing;
    writing.keepPrecision = true;
    stats.lossless = stats.lossless && stats.maxError == 0;
    writeConverted(files, std::move(volumes), writing, partOf(listener, kReadShare, 1), stats);
    return stats;
}

void runRestore(const CLI::App& app, const RestoreCommand& command, const Session& session) {
    checkFirstOutput(command.files, command.frames, checkVolumeFile);
    runConversion(app, command.files, command.frames, session,
                  [&](const ConversionFiles& files, const Listener& listener) {
                      return restoreFile(command, files, listener);
                  });
}

}  // namespace

Subcommand addRestore(CLI::App& program) {
    const auto command = std::make_shared<RestoreCommand>();
    command->read.levelSetToFog = false;
    command->read.keepSource = true;
    CLI::App& app =
        addSubcommand(program, "restore", "Restores the volume that delta grids were made from.",
                      {"deltasplat restore smoke_delta.vdb smoke.vdb",
                       "deltasplat restore head.vdb head_256x256x225_uint8.raw"});
    return {&app, [&app, command] { declareOptions(app, *command); },
            [&app, command](const Session& session) { runRestore(app, *command, session); }};
}

}  // namespace deltasplat
