// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/progress.h"
#include "sequence/frame_name.h"

namespace deltasplat {

/// What becomes of frames that have no input.
enum class MissingFrames {
    kError,  ///< they have failed
    kSkip,   ///< nothing is made of them
    kBlack,  ///< they are black
    kHold    ///< they show the frame before, or of the first ones the next that there is
};

/// Which frames of a sequence are worked on, and what becomes of those that cannot be.
struct FrameChoice {
    std::vector<int> frames;  ///< empty: no sequence
    MissingFrames missing = MissingFrames::kError;
    bool keepGoing = false;            ///< whether the others are made if some have failed
    bool skipExisting = false;         ///< leave alone what is there and whole
    bool update = false;               ///< the same of what is no older than its input
    std::string askedBy = "--frames";  ///< the option that they are given by, for messages

    bool asked() const { return !frames.empty(); }
};

/// Declares all of it.
/// @param arePictures  whether frames may be black
void addFrameOptions(CLI::App& app, FrameChoice& choice, bool arePictures);

/// Declares which frames are only looked at, and whether those without a file are passed over.
void addFrameList(CLI::App& app, FrameChoice& choice);

/// A file of each frame.
struct FrameFiles {
    int frame;
    std::filesystem::path input;
    std::filesystem::path output;
    std::string name = {};  ///< for messages; empty: "frame" and its number
};

/// Returns the files of all frames that are asked for, in their order. Says where a number stands
/// in the name of a folder.
/// @param outputOption  what names the output, for messages
/// @throw Error(kUsage) unless input and output both have a place for the frame's number, which
///        `mayStand` lets the input do without; or if two frames have the same output
std::vector<FrameFiles> filesOfFrames(const FrameChoice& choice, const std::filesystem::path& input,
                                      bool mayStand, const std::string& outputOption,
                                      const std::filesystem::path& output,
                                      const Listener& listener);

/// Returns a name with a place for the frame's number.
/// @throw Error(kUsage) naming the option, if it has none
FrameName frameNameOf(const FrameChoice& choice, const std::string& option,
                      const std::filesystem::path& file);

/// @throw Error(kUsage) always: the option is given without --frames
[[noreturn]] void refuseWithoutFrames(const std::string& option);

/// Returns the file of each frame that is asked for, of the input alone. Says where a number stands
/// in the name of a folder.
/// @param option  what names it, for messages
/// @throw Error(kUsage) if it has no place for a frame's number
std::vector<FrameFiles> inputsOfFrames(const FrameChoice& choice, const std::string& option,
                                       const std::filesystem::path& input,
                                       const Listener& listener);

/// Makes signs stand for themselves in names without a place for a frame's number. Where no frames
/// are asked for, refuses names with one, if there is no such file, and options that frames alone
/// have.
/// @throw Error(kUsage)
void settleNames(const CLI::App& app, const FrameChoice& choice, std::filesystem::path& input);
/// @param output  empty: none
void settleNames(const CLI::App& app, const FrameChoice& choice, std::filesystem::path& input,
                 std::filesystem::path& output);

}  // namespace deltasplat
