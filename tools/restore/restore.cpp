// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "conversion/conversion_files.h"
#include "conversion/conversion_stats.h"
#include "deltasplat/convert/write_volume.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/list_grids.h"
#include "deltasplat/ingest/read_volume.h"
#include "ingest/files/input_files.h"
#include "ingest/files/input_kind.h"
#include "listener.h"
#include "lower_case.h"
#include "options/input_options.h"
#include "output_files.h"
#include "stopwatch.h"
#include "subcommands.h"

namespace deltasplat {
namespace {

// Share of the progress that reading takes.
constexpr double kReadShare = 0.5;

struct RestoreCommand {
    std::filesystem::path input;
    std::filesystem::path output;
    std::filesystem::path stats;  // empty: none
    ReadOptions read;

    bool toVdb() const { return lowerCase(output.extension().string()) == ".vdb"; }
};

void declareOptions(CLI::App& app, RestoreCommand& command) {
    OptionGroup arguments(app, "Arguments");
    arguments.addValue("INPUT", "FILE.vdb", command.input, anyText(), "Delta grids to read")
        .required();
    arguments
        .addValue("OUTPUT", "FILE", command.output, anyText(),
                  "File to write: .vdb .npy .nrrd .nhdr .mhd .mha .nii .nii.gz\n"
                  ".raw or .raw.gz; a .vdb gets all delta grids, others the first")
        .required();
    OptionGroup options(app, "Restoring");
    addConfineOption(app);
    options.addValue("--grid", "NAME", command.read.gridName, anyText(),
                     "Grid to restore (default: all that the output can hold)");
    options.addValue("--stats", "FILE", command.stats, anyText(),
                     "JSON file to write: sizes, deltas, largest error, seconds");
}

void requireVdb(const RestoreCommand& command) {
    const InputKind kind = findInput(command.input, {});
    if (kind.format == InputKind::Format::kVdb) return;
    if (inputsAreConfined()) requireConfined(command.input);
    throw Error(ErrorCode::kInput,
                gotExpected(command.input.string(), "another format",
                            "a .vdb of delta grids (convert takes other formats)"));
}

void requireDeltas(const RestoreCommand& command, const Volume& volume) {
    if (volume.origin) return;
    throw Error(
        ErrorCode::kInput,
        gotExpected(command.input.string() + ": grid \"" + volume.name + "\"",
                    "a grid of type " + volume.type, "a delta grid (convert takes other grids)"));
}

std::string joined(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

// The delta grids that the output can hold, by name. Without any, reading says what is wrong.
std::vector<std::string> chooseGrids(const RestoreCommand& command, const Listener& listener,
                                     ConversionStats& stats) {
    requireVdb(command);
    if (!command.read.gridName.empty()) return {command.read.gridName};
    GridList grids = listGrids(command.input);
    if (grids.deltas.empty()) return {grids.scalar.empty() ? "" : grids.scalar.front()};
    const std::string where = command.input.string() + ": ";
    if (!grids.ordinary.empty()) {
        listener.warn(where + "left out " + joined(grids.ordinary) + ", which are no delta grids");
    }
    if (!command.toVdb() && grids.deltas.size() > 1) {
        listener.warn(where + "reading grid \"" + grids.deltas.front() + "\", the first of " +
                      std::to_string(grids.deltas.size()) + " delta grids");
        grids.deltas.resize(1);
    }
    stats.lossless = grids.ordinary.empty() || !command.toVdb();
    return grids.deltas;
}

std::vector<Volume> readInput(const RestoreCommand& command, const Listener& listener,
                              ConversionStats& stats) {
    std::vector<Volume> volumes;
    const std::vector<std::string> names = chooseGrids(command, listener, stats);
    for (const std::string& name : names) {
        const double done = double(volumes.size());
        Listener part = listener;
        part.progress = [&, done](double share) {
            listener.report((done + share) / double(names.size()));
        };
        ReadOptions options = command.read;
        options.gridName = name;
        Volume volume = readVolume(command.input, options, part);
        requireDeltas(command, volume);
        stats.add(volume);
        stats.deltas += volume.origin->deltas;
        stats.maxError = std::max(stats.maxError, volume.origin->maxError);
        // The source says all that the codes do, and more.
        if (volume.source) volume.codes.reset();
        volumes.push_back(std::move(volume));
    }
    return volumes;
}

void runRestore(const RestoreCommand& command, const Session& session) {
    checkVolumeFile(command.output);
    ConversionStats stats;
    // Asked before writing, which may take the input's place.
    stats.inputBytes = bytesOf(checkConversionFiles(command.input, command.output, command.stats));
    {
        ProgressDisplay display(session.common);
        std::vector<Volume> volumes = readInput(command, display.stage(0, kReadShare), stats);
        WriteOptions writing;
        writing.keepPrecision = true;
        const WriteReport report =
            writeVolumes(command.output, std::move(volumes), writing, display.stage(kReadShare, 1));
        for (const std::string& note : report.notes) display.warn(note);
        stats.outputBytes = bytesOf(report.files);
        stats.lossless = stats.lossless && report.lossless && stats.maxError == 0;
        stats.maxError = std::max(stats.maxError, report.maxError);
        stats.seconds = secondsSince(session.begin);
    }
    writeStats(command.stats, statsJson(stats));
    if (session.common.verbose) std::fputs(statsSummary(stats).c_str(), stderr);
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
    declareOptions(app, *command);
    return {&app, [command](const Session& session) { runRestore(*command, session); }};
}

}  // namespace deltasplat
