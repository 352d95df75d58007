// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "deltasplat/progress.h"
#include "sequence/frame_options.h"

namespace deltasplat {

/// What is known of a sequence of which some frames are made.
struct KnownSequence {
    /// The input that frames hold before the first of these that has one; empty: none.
    std::filesystem::path held;
};

/// Returns the frames that something can be made of: those without an input stay, and will fail;
/// are left out, with a remark; or get another frame's input, or, to be black, an empty one.
/// @param known  if it is, none of the frames need have an input
/// @throw Error(kInput) if no frame has an input
std::vector<FrameFiles> withInputs(const std::vector<FrameFiles>& frames, MissingFrames missing,
                                   const Listener& listener,
                                   const std::optional<KnownSequence>& known = {});

/// Whether a file, or a stack of files, is there to be read.
bool hasInput(const std::filesystem::path& input);

/// @throw Error(kInput) that counts them if frames have no input, unless that is the same of all
void requireInputs(const std::vector<FrameFiles>& frames);

/// Returns the frames whose output is not there already, as far as the choice asks for that.
std::vector<FrameFiles> framesToMake(const std::vector<FrameFiles>& frames,
                                     const FrameChoice& choice);

}  // namespace deltasplat
