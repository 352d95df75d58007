// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "conversion/conversion_files.h"
#include "conversion/conversion_stats.h"
#include "conversion/read_grids.h"
#include "deltasplat/convert/write_volume.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/read_volume.h"
#include "listener.h"
#include "lower_case.h"
#include "options/input_options.h"
#include "output_files.h"
#include "stopwatch.h"
#include "subcommands.h"

namespace deltasplat {
namespace {

// What a leaf of floats takes for an 8x8x8 block that is not uniform.
constexpr double kBytesPerBlock = 2200;

// Share of the progress that reading takes.
constexpr double kReadShare = 0.5;

struct ConvertCommand {
    std::filesystem::path input;
    std::filesystem::path output;
    std::filesystem::path stats;  // empty: none
    ReadOptions read;
    WriteOptions write;

    bool toVdb() const { return lowerCase(output.extension().string()) == ".vdb"; }
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
            throw Error(ErrorCode::kUsage,
                        gotExpected(option, text, "a finite number, auto or none"));
        }
        return options;
    };
}

void declareOptions(CLI::App& app, ConvertCommand& command) {
    OptionGroup arguments(app, "Arguments");
    arguments
        .addValue("INPUT", "FILE", command.input, anyText(),
                  std::string("Volume to read: ") + kInputFormats)
        .required();
    arguments
        .addValue("OUTPUT", "FILE", command.output, anyText(),
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
    output.addValue("--stats", "FILE", command.stats, anyText(),
                    "JSON file to write: sizes, largest error, seconds");
    addInputOptions(app, command.read);
}

void warnOfUnusedOptions(const CLI::App& app, const ConvertCommand& command,
                         ProgressDisplay& display) {
    warnOfUnusedInputOptions(app, {command.input}, display);
    for (const char* const option : {"--float", "--background"}) {
        if (isGiven(app, option) && !command.toVdb())
            display.warn(std::string(option) + ": has no effect without a .vdb output");
    }
}

// Sets `complete` unless grids are left out.
std::vector<Volume> readInput(const ConvertCommand& command, const Listener& listener,
                              bool& complete) {
    std::vector<Volume> volumes;
    if (!command.toVdb()) {
        volumes.push_back(readVolume(command.input, command.read, listener));
        return volumes;
    }
    complete = forEachScalarGrid(
        command.input, command.read,
        [&](Volume volume) {
            // The source says all that the codes do, and more.
            if (volume.source) volume.codes.reset();
            volumes.push_back(std::move(volume));
        },
        listener);
    return volumes;
}

void runConvert(const CLI::App& app, const ConvertCommand& command, const Session& session) {
    checkVolumeFile(command.output);
    ConversionStats stats;
    // Asked before writing, which may take the input's place.
    stats.inputBytes = bytesOf(checkConversionFiles(command.input, command.output, command.stats));
    {
        ProgressDisplay display(session.common);
        warnOfUnusedOptions(app, command, display);
        bool complete = true;
        std::vector<Volume> volumes = readInput(command, display.stage(0, kReadShare), complete);
        for (const Volume& volume : volumes) stats.add(volume);

        const WriteReport report = writeVolumes(command.output, std::move(volumes), command.write,
                                                display.stage(kReadShare, 1));
        for (const std::string& note : report.notes) display.warn(note);
        stats.outputBytes = bytesOf(report.files);
        stats.maxError = std::max(stats.maxError, report.maxError);
        stats.lossless = stats.lossless && report.lossless && complete;
        stats.seconds = secondsSince(session.begin);
    }
    writeStats(command.stats, statsJson(stats));
    if (session.common.verbose) std::fputs(statsSummary(stats).c_str(), stderr);
}

}  // namespace

Subcommand addConvert(CLI::App& program) {
    const auto command = std::make_shared<ConvertCommand>();
    // What is in a file is passed on as it is, not as it would be rendered.
    command->read.levelSetToFog = false;
    command->read.keepSource = true;
    command->read.bytesPerBlock = kBytesPerBlock;
    CLI::App& app = addSubcommand(
        program, "convert", "Converts a volume to another format.",
        {"deltasplat convert engine_256x256x128_uint8.raw.gz engine.vdb --background auto",
         "deltasplat convert smoke.vdb smoke.nrrd --grid density"});
    declareOptions(app, *command);
    return {&app, [&app, command](const Session& session) { runConvert(app, *command, session); }};
}

}  // namespace deltasplat
