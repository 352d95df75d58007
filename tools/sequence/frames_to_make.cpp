// SPDX-License-Identifier: Apache-2.0
#include "sequence/frames_to_make.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>

#include "deltasplat/error.h"
#include "deltasplat/ingest/list_grids.h"
#include "formats/input_files.h"
#include "formats/input_kind.h"
#include "image/quantize.h"
#include "output_files.h"
#include "process/run_log.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

bool isReadable(const fs::path& output) {
    std::error_code error;
    if (!fs::is_regular_file(output, error) || fs::file_size(output, error) == 0) return false;
    if (isImageName(output)) return isWholeImage(output);
    try {
        return !listVolumes(output, {}).empty();
    } catch (const Error&) {
        return false;
    }
}

// Whether an output is no older than any file of its input.
bool isNew(const FrameFiles& frame) {
    if (frame.input.empty()) return true;
    std::error_code error;
    const auto made = fs::last_write_time(frame.output, error);
    if (error) return false;
    try {
        for (const fs::path& file : filesOf(frame.input)) {
            const auto changed = fs::last_write_time(file, error);
            if (error || changed > made) return false;
        }
    } catch (const Error&) {
        return false;
    }
    return true;
}

}  // namespace

bool hasInput(const fs::path& input) {
    // What cannot be looked at may be there: reading it says why.
    std::error_code error;
    if (fs::exists(input, error) || error) return true;
    if (!isImageName(input)) return false;
    try {
        return !findInput(input, {}).files.empty();  // a stack
    } catch (const Error&) {
        return false;
    }
}

std::vector<FrameFiles> withInputs(const std::vector<FrameFiles>& frames, MissingFrames missing,
                                   const Listener& listener, const std::optional<fs::path>& held) {
    if (missing == MissingFrames::kError) return frames;
    std::vector<FrameFiles> result;
    std::optional<fs::path> before;
    if (held && !held->empty()) before = held;
    std::size_t absent = 0;
    for (const FrameFiles& frame : frames) {
        const bool isPresent = hasInput(frame.input);
        if (!isPresent) ++absent;
        if (isPresent) {
            // Those before the first one show it.
            if (!before && missing == MissingFrames::kHold)
                for (FrameFiles& early : result) early.input = frame.input;
            before = frame.input;
        }
        if (isPresent || missing == MissingFrames::kHold) {
            result.push_back(
                {frame.frame, isPresent || !before ? frame.input : *before, frame.output});
        } else if (missing == MissingFrames::kBlack) {
            result.push_back({frame.frame, {}, frame.output});
        }
    }
    if (!before && !held && missing != MissingFrames::kBlack)
        refuseWithoutInputs(frames.front().input);
    if (absent > 0) {
        listener.warn("--missing: " + std::to_string(absent) + " of " +
                      std::to_string(frames.size()) + " frames have no file and " +
                      (missing == MissingFrames::kHold    ? "show another"
                       : missing == MissingFrames::kBlack ? "are black"
                                                          : "are left out"));
    }
    return result;
}

void refuseWithoutInputs(const fs::path& input) {
    throw Error(ErrorCode::kInput, input.string(), "no file of any frame", "at least one");
}

void requireInputs(const std::vector<FrameFiles>& frames) {
    std::vector<FrameFiles> absent;
    std::copy_if(frames.begin(), frames.end(), std::back_inserter(absent),
                 [](const FrameFiles& frame) { return !hasInput(frame.input); });
    if (absent.empty() || frames.front().input == frames.back().input) return;
    throw Error(ErrorCode::kInput, absent.front().input.string(),
                "no such file (" + std::to_string(absent.size()) + " of " +
                    std::to_string(frames.size()) + " frames have none)",
                "one of each, or --missing skip, hold or black");
}

void requireOwnOutputs(const std::string& option, const std::vector<FrameFiles>& frames,
                       const fs::path& other, const std::string& name) {
    const fs::path log = runLogFile().filename();
    for (const FrameFiles& frame : frames) {
        // There may be a million of them: only such as are called the same are looked at.
        const fs::path file = frame.output.filename();
        if (file == log || file == other.filename())
            requireOther(option, frame.output, {other}, name);
    }
}

std::vector<FrameFiles> framesToMake(const std::vector<FrameFiles>& frames,
                                     const FrameChoice& choice,
                                     const std::optional<FrameName>& stats) {
    std::vector<FrameFiles> result;
    std::error_code ignored;
    for (const FrameFiles& frame : frames) {
        const bool hasStats = !stats || fs::is_regular_file(stats->at(frame.frame), ignored);
        const bool isDone =
            hasStats && ((choice.skipExisting && isReadable(frame.output)) ||
                         (choice.update && isReadable(frame.output) && isNew(frame)));
        if (!isDone) result.push_back(frame);
    }
    return result;
}

}  // namespace deltasplat
