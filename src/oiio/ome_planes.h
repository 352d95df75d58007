// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace deltasplat {

/// A picture of up to five axes, from OME-XML.
struct OmePicture {
    std::int64_t slices = 1, channels = 1, times = 1;
    std::vector<std::int64_t> pages;  ///< of planes: slices fastest, channels, times; -1: unknown
    glm::dvec3 spacing{0.0};          ///< of pixels and slices, in lengthUnit; 0: unknown
    std::string lengthUnit;           ///< as Volume::lengthUnit
    std::string otherFile;            ///< that holds planes; empty: all are in this file
};

/// Returns the pictures in OME-XML; none for other text.
/// @param samples  values per pixel of a page; OME counts them as channels
/// @throw Error(kInput) for impossible sizes
std::vector<OmePicture> readOme(const std::filesystem::path& file, const std::string& text,
                                int samples);

}  // namespace deltasplat
