// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>

#include "base/progress.h"
#include "conversion/read_grids.h"
#include "conversion/run_conversion.h"
#include "deltasplat/convert/write_volume.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/read_volume.h"
#include "formats/readers.h"
#include "optics/label_function.h"
#include "options/input_options.h"
#include "subcommands.h"

namespace deltasplat {
namespace {

// What a leaf takes for an 8x8x8 block that is not uniform: one of floats, of values that codes are
// not enough for, and one of codes of which a background is dropped.
constexpr double kBytesPerInexactBlock = 2200;
constexpr double kBytesPerDroppedBlock = 1200;

// Share of the progress that reading takes.
constexpr double kReadShare = 0.5;

struct ConvertCommand {
    ConversionFiles files;
    FrameChoice frames;
    ReadOptions read;
    WriteOptions write;
    std::filesystem::path labels;  // empty: those that the input has
};

// "auto", "none" or a number.
Parser<WriteOptions> background(const WriteOptions& before) {
    return [&before](const std::string& option, const std::string& text) {
        WriteOptions options = before;
        options.dropBackground = text != "none";
        options.background.reset();
        if (text == "auto" || text == "none") return options;
        try {
            options.background = number()(option, text);
        } catch (const Error&) {
            throw Error(ErrorCode::kUsage, option, text, "a finite number, auto or none");
        }
        return options;
    };
}

void declareOptions(CLI::App& app, ConvertCommand& command) {
    OptionGroup arguments(app, "Arguments");
    arguments
        .addValue("INPUT", "FILE", command.files.input, anyText(),
                  std::string("Volume to read: ") + kInputFormats)
        .required();
    arguments
        .addValue("OUTPUT", "FILE", command.files.output, anyText(),
                  "File to write: .vdb .npy .nrrd .nhdr .mhd .mha .nii .nii.gz\n"
                  ".raw or .raw.gz; of the input's grids a .vdb gets all scalar\n"
                  "ones, the others the first")
        .required();

    OptionGroup output(app, "Output");
    output.addFlag("--float", command.write.fullFloat,
                   "Store 32-bit floats in a .vdb, not halves where those are exact");
    output.addValue("--background", "V|auto|none", command.write, background(command.write),
                    "Make voxels of this value inactive in a .vdb, and it the\n"
                    "background; auto: the background that a .vdb has, what info\n"
                    "guesses for other inputs (default none: every voxel stays as\n"
                    "active as it was)");
    output.addValue("--labels", "TABLE", command.labels, anyText(),
                    "Names and colours of labels, a table of 3D Slicer or ITK-SNAP, to\n"
                    "keep in a .vdb, or in a .nrrd as segments of 3D Slicer (default:\n"
                    "those that the input has)");
    addConversionOptions(app, "sizes, largest error, seconds", command.files, command.frames);
    addInputOptions(app, command.read);
}

void warnOfUnusedOptions(const CLI::App& app, const ConvertCommand& command,
                         const std::filesystem::path& input, const Listener& listener) {
    warnOfUnusedInputOptions(app, {input}, listener);
    for (const char* const option : {"--float", "--background"}) {
        if (isGiven(app, option) && !command.files.toVdb())
            listener.warn(std::string(option) + ": has no effect without a .vdb output");
    }
}

// Sets `complete` unless grids are left out.
std::vector<Volume> readInput(const ConvertCommand& command, const std::filesystem::path& input,
                              const Listener& listener, bool& complete) {
    std::vector<Volume> volumes;
    if (!command.files.toVdb()) {
        volumes.push_back(readCompared(input, command.read, listener));
        return volumes;
    }
    ReadOptions reading = command.read;
    if (command.write.dropBackground) reading.bytesPerBlock = kBytesPerDroppedBlock;
    const std::string others = forEachScalarGrid(
        input, reading,
        [&](Volume volume) {
            // The source says all that the codes do, and more.
            if (volume.source()) volume = volume.withoutCodes();
            volumes.push_back(std::move(volume));
        },
        listener);
    complete = others.empty();
    return volumes;
}

ConversionStats convertFile(const CLI::App& app, const ConvertCommand& command,
                            const ConversionFiles& files, const Listener& listener) {
    ConversionStats stats;
    warnOfUnusedOptions(app, command, files.input, listener);
    bool complete = true;
    std::shared_ptr<const LabelList> labels;
    if (!command.labels.empty())
        labels = std::make_shared<const LabelList>(readLabelList(command.labels));
    std::vector<Volume> volumes =
        readInput(command, files.input, partOf(listener, 0, kReadShare), complete);
    for (Volume& volume : volumes) {
        if (labels) volume = volume.withLabels(labels);
        stats.add(volume, volume.codeBook().name());
    }

    writeConverted(files, std::move(volumes), command.write, partOf(listener, kReadShare, 1),
                   stats);
    stats.lossless = stats.lossless && complete;
    return stats;
}

void runConvert(const CLI::App& app, const ConvertCommand& command, const Session& session) {
    checkFirstOutput(command.files, command.frames, checkVolumeFile);
    runConversion(app, command.files, command.frames, session,
                  [&](const ConversionFiles& files, const Listener& listener) {
                      return convertFile(app, command, files, listener);
                  });
}

}  // namespace

Subcommand addConvert(CLI::App& program) {
    const auto command = std::make_shared<ConvertCommand>();
    // What is in a file is passed on as it is, not as it would be rendered.
    command->read.levelSetToFog = false;
    command->read.keepSource = true;
    command->read.bytesPerInexactBlock = kBytesPerInexactBlock;
    CLI::App& app = addSubcommand(
        program, "convert", "Converts a volume to another format.",
        {"deltasplat convert engine_256x256x128_uint8.raw.gz engine.vdb --background auto",
         "deltasplat convert smoke.vdb smoke.nrrd --grid density"});
    return {&app, [&app, command] { declareOptions(app, *command); },
            [&app, command](const Session& session) { runConvert(app, *command, session); }};
}

}  // namespace deltasplat
