// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace deltasplat {

/// Returns every file that an input consists of, itself first if it is a file: a header and its
/// data file, the images that a pattern stands for, or the slices in a folder. Only names, headers
/// and the first bytes of a folder's files are looked at; a data file that a header names need not
/// exist. Of an input that cannot be read, it returns the input alone: what is wrong is for its
/// reader to say.
std::vector<std::filesystem::path> filesOf(const std::filesystem::path& input);

/// From now on readers refuse inputs that are not confined as requireConfined says. For a whole
/// program, as memory limits are; not thread-safe.
void confineInputs();
bool inputsAreConfined();

/// Checks that all files of an input, links followed, lie in its folder, or in the folder that it
/// is, or below.
/// @throw Error(kInput) "<input>: got <file>, which is outside of <folder>; expected ..."
void requireConfined(const std::filesystem::path& input);

/// Checks, where inputs are confined at all, that the folder of an input that a pattern stands for
/// lies, links followed, in the pattern's own: the one before the first folder of any name.
/// @throw Error(kInput)
void requireFoundIn(const std::filesystem::path& folder, const std::filesystem::path& input);

/// The same of a file that an input names, where inputs are confined at all.
void requireConfined(const std::filesystem::path& input, const std::filesystem::path& named);

}  // namespace deltasplat
