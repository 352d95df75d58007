// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <string_view>

namespace deltasplat {

/// Throws unless a page with pictures of this size could be written into the folder, which need not
/// exist: asked before long work.
/// @throw Error(kUsage) for a size that a .png cannot have; Error(kOutput) if the folder, or the
/// one it is to be made in, cannot be written to
void checkPageFolder(const std::filesystem::path& folder, glm::ivec2 pictureSize);

/// Returns the page's file in the folder.
std::filesystem::path pageIn(const std::filesystem::path& folder);

/// Writes `index.html` into the folder, which is made if it does not exist. The page appears when
/// it is whole; if it cannot be written, a folder that was made is removed.
/// @throw Error(kOutput)
void writePage(const std::filesystem::path& folder, std::string_view page);

}  // namespace deltasplat
