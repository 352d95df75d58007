// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <functional>
#include <string>

namespace deltasplat {

/// Encodes in memory, so that what can go wrong with the disk goes wrong in one place.
/// @param file         for messages
/// @param writePixels  false if the output's error says why not
std::string encodeInMemory(const std::filesystem::path& file, const char* formatName,
                           const OIIO::ImageSpec& spec,
                           const std::function<bool(OIIO::ImageOutput&)>& writePixels);

}  // namespace deltasplat
