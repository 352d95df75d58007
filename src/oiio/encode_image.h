// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <functional>
#include <string>

namespace deltasplat {

/// Encodes an image in memory; the caller writes the file, so disk errors are handled in one place.
/// @param writePixels  returns false if the output's error message has the reason
std::string encodeInMemory(const std::filesystem::path& file, const char* formatName,
                           const OIIO::ImageSpec& spec,
                           const std::function<bool(OIIO::ImageOutput&)>& writePixels);

}  // namespace deltasplat
