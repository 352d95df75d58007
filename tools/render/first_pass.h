// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/progress.h"

namespace deltasplat {

struct RenderCommand;
class SequenceLook;

/// Returns the options that were given of those that choose which voxels are read.
std::string readingOptions(const CLI::App& app);

/// Takes what all frames are shown by from the command's `--first-pass` file, if it is there, and
/// returns what the first frames hold that have no file.
/// Warns if it was made of another input, of another file of the first frame, with other options of
/// reading or without some frames.
/// @throw Error(kInput) if the file is something else
std::optional<std::filesystem::path> readFirstPass(const RenderCommand& command, SequenceLook& look,
                                                   const Listener& listener);

/// @throw Error(kOutput) if the command's `--first-pass` file cannot be written
void requireWritableFirstPass(const RenderCommand& command);

/// Writes the command's `--first-pass` file.
/// @param frames  those that were read, in any order
/// @throw Error(kOutput)
void writeFirstPass(const RenderCommand& command, const std::vector<int>& frames,
                    const SequenceLook& look);

}  // namespace deltasplat
