// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace deltasplat {

/// A picture of up to five axes, as OME-XML describes it.
struct OmePicture {
    std::int64_t slices = 1, channels = 1, times = 1;
    /// Of each plane its page, slices counting fastest, then channels, then times; -1: none is
    /// known.
    std::vector<std::int64_t> pages;
    /// Lengths of a pixel and between slices, in lengthUnit; 0: not said.
    glm::dvec3 spacing{0.0};
    std::string lengthUnit;  ///< as Volume::lengthUnit
    /// The name of another file in which planes lie; empty: all are here.
    std::string otherFile;
};

/// Returns the pictures that OME-XML describes; none for another text.
/// @param file     that has the text
/// @param samples  values of each pixel of a page, which are channels to OME
/// @throw Error(kInput) for sizes that cannot be meant
std::vector<OmePicture> readOme(const std::filesystem::path& file, const std::string& text,
                                int samples);

}  // namespace deltasplat
