// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "deltasplat/progress.h"
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

/// Returns the frames whose output is not there already, as far as the choice asks for that.
std::vector<FrameFiles> framesToMake(const std::vector<FrameFiles>& frames,
                                     const FrameChoice& choice);

}  // namespace deltasplat
