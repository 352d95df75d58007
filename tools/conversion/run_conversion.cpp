// SPDX-License-Identifier: Apache-2.0
#include "conversion/run_conversion.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/progress.h"
#include "conversion/conversion_files.h"
#include "deltasplat/threads.h"
#include "files/file_name.h"
#include "formats/input_files.h"
#include "modules/load_early.h"
#include "output_files.h"
#include "process/interrupt.h"
#include "sequence/frame_name.h"
#include "sequence/frames_to_make.h"
#include "sequence/run_frames.h"

namespace deltasplat {
namespace {

// Of the memory there is, what conversions may take that go on at the same time, and what each
// takes of a byte that it reads: compressed halves become floats, and they codes.
constexpr double kWorkShare = 0.5;
constexpr double kBytesPerByte = 40;

ConversionStats convertOne(const ConversionFiles& files, const Convert& convert,
                           const Listener& listener) {
    const auto begin = std::chrono::steady_clock::now();
    // Asked before writing, which may take the input's place.
    const std::uint64_t bytes =
        bytesOf(checkConversionFiles(files.input, files.output, files.stats));
    ConversionStats stats = convert(files, listener);
    if (stats.areLabels && stats.maxError > 0)
        listener.warn(files.output.string() +
                      ": has other labels than the input, taken for quantities");
    stats.inputBytes = bytes;
    stats.seconds = secondsSince(begin);
    return stats;
}

int workersFor(const std::vector<FrameFiles>& frames) {
    std::uint64_t largest = 1;
    for (const FrameFiles& frame : frames) largest = std::max(largest, bytesOf({frame.input}));
    const double fitting =
        kWorkShare * double(availableMemory()) / (kBytesPerByte * double(largest));
    return std::max(1, int(std::min(double(threadCount()), fitting)));
}

ConversionStats convertFrames(const ConversionFiles& files, const FrameChoice& choice,
                              const Convert& convert, const Listener& listener) {
    interruptBetweenFiles();
    std::optional<FrameName> stats;
    if (!files.stats.empty()) stats = frameNameOf(choice, "--stats", files.stats);
    const std::vector<FrameFiles> asked =
        filesOfFrames(choice, files.input, false, "OUTPUT", files.output, listener);
    requireOwnOutputs("OUTPUT", asked, {}, "");
    const std::vector<FrameFiles> frames =
        framesToMake(withInputs(asked, choice.missing, listener), choice, stats);
    std::vector<ConversionStats> each(frames.size());
    OutputFolders folders;
    runFrames(
        frames, choice.keepGoing, workersFor(frames),
        [&](std::size_t i, const Listener& part) {
            ConversionFiles one{frames[i].input, frames[i].output, {}};
            if (stats) one.stats = stats->at(frames[i].frame);
            folders.makeFor(one.output);
            folders.makeFor(one.stats);
            each[i] = convertOne(one, convert, part);
            writeStats(one.stats, statsJson(each[i]));
        },
        listener);
    ConversionStats all;
    for (const ConversionStats& stats : each) all.add(stats);
    return all;
}

}  // namespace

bool ConversionFiles::toVdb() const {
    return lowerExtension(output) == ".vdb";
}

void writeConverted(const ConversionFiles& files, std::vector<Volume> volumes,
                    const WriteOptions& options, const Listener& listener, ConversionStats& stats) {
    const WriteReport report = writeVolumes(files.output, std::move(volumes), options, listener);
    for (const std::string& note : report.notes) listener.warn(note);
    stats.outputBytes = bytesOf(report.files);
    stats.maxError = std::max(stats.maxError, report.maxError);
    stats.lossless = stats.lossless && report.lossless;
}

void checkFirstOutput(const ConversionFiles& files, const FrameChoice& frames,
                      const std::function<void(const std::filesystem::path& output)>& check) {
    const std::optional<FrameName> name = FrameName::find(files.output);
    if (!frames.asked() || !name) return check(plainName(files.output));
    const std::filesystem::path first = name->at(frames.frames.front());
    // Made again for each frame that has something to write.
    OutputFolders folders;
    folders.makeFor(first);
    check(first);
}

void addConversionOptions(CLI::App& app, const std::string& what, ConversionFiles& files,
                          FrameChoice& frames) {
    OptionGroup(app, "Output")
        .addValue("--stats", "FILE", files.stats, anyText(), "JSON file to write: " + what);
    addFrameOptions(app, frames, false);
}

ConversionStats runConversion(const CLI::App& app, ConversionFiles files, const FrameChoice& frames,
                              const Session& session, const Convert& convert) {
    settleNames(app, frames, files.input, files.output);
    if (!frames.asked()) files.stats = plainName(files.stats);
    if (frames.asked() && !files.stats.empty()) frameNameOf(frames, "--stats", files.stats);
    const std::jthread loading = loadEarly(files.input);
    ConversionStats stats;
    {
        ProgressDisplay display(session.common);
        const Listener listener = display.stage(0, 1);
        stats = frames.asked() ? convertFrames(files, frames, convert, listener)
                               : convertOne(files, convert, listener);
        stats.seconds = secondsSince(session.begin);
    }
    if (!frames.asked()) writeStats(files.stats, statsJson(stats));
    if (session.common.verbose) std::fputs(statsSummary(stats).c_str(), stderr);
    return stats;
}

}  // namespace deltasplat
