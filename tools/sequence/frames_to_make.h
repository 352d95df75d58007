// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/progress.h"
#include "sequence/frame_name.h"
#include "sequence/frame_options.h"

namespace deltasplat {

/// Returns the frames that something can be made of: those without an input stay, and will fail;
/// are left out, with a remark; or get another frame's input, or, to be black, an empty one.
/// @param held  where the whole sequence is known, of which these are some: the input that the
///              first ones without one show, or an empty name; none of them need have one then
/// @throw Error(kInput) if no frame has an input
std::vector<FrameFiles> withInputs(const std::vector<FrameFiles>& frames, MissingFrames missing,
                                   const Listener& listener,
                                   const std::optional<std::filesystem::path>& held = {});

/// Whether a file, or a stack of files, is there to be read.
bool hasInput(const std::filesystem::path& input);

/// @throw Error(kInput) that says that no frame has an input
[[noreturn]] void refuseWithoutInputs(const std::filesystem::path& input);

/// @throw Error(kInput) that counts them if frames have no input, unless that is the same of all
void requireInputs(const std::vector<FrameFiles>& frames);

/// Refuses, before any is made, frames whose output is the log or another file of the command.
/// @param option  that gives the frames their outputs
/// @param other   empty: none; called `name` in the message
/// @throw Error(kUsage)
void requireOwnOutputs(const std::string& option, const std::vector<FrameFiles>& frames,
                       const std::filesystem::path& other, const std::string& name);

/// Returns the frames whose output is not there already, as far as the choice asks for that, and
/// what goes beside it.
/// @param stats  the files that each frame's --stats go to, if any do
std::vector<FrameFiles> framesToMake(const std::vector<FrameFiles>& frames,
                                     const FrameChoice& choice,
                                     const std::optional<FrameName>& stats = {});

}  // namespace deltasplat
