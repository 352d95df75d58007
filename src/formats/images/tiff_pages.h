// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace deltasplat {

/// A page's table, and how to make it the only page: the header names its table first, and the
/// table names no next one.
struct TiffPage {
    std::uint64_t table = 0;         ///< offset of the page's table
    std::uint64_t nextField = 0;     ///< offset of the field that names the next page's table
    bool whiteIsZero = false;        ///< smaller values are meant to look brighter
    bool isReduced = false;          ///< a thumbnail, a smaller copy or a mask of another page
    std::uint64_t paletteField = 0;  ///< of the 2 bytes that declare palette indices; 0: none
    /// Offset and length of the pixels if they are stored as in memory: unpacked, row by row, whole
    /// bytes, samples interleaved. Else 0.
    std::uint64_t pixels = 0;
    std::uint64_t pixelBytes = 0;
    std::uint64_t roomBytes = 0;  ///< from `pixels` to the page's next data, or the file's end
};

struct TiffPages {
    bool bigEndian = false;
    int offsetBytes = 4;           ///< bytes per offset: 4, or 8 in a BigTIFF
    std::uint64_t firstField = 4;  ///< offset of the field that names the first page's table
    std::vector<TiffPage> pages;   ///< in order, at least one
    // About the first page:
    std::string description;            ///< text by the program that wrote the file
    int samples = 1;                    ///< values per pixel
    glm::dvec2 pixelsPerUnit{0.0};      ///< 0: unknown
    int resolutionUnit = 2;             ///< 1: none, 2: inch, 3: centimetre
    std::uint64_t metaMorphPlanes = 0;  ///< planes of a MetaMorph stack; 0 if it is none
};

/// Follows the chain of pages in linear time and checks each page's claims about its pixels against
/// the file, because libtiff stops silently at a page that it cannot read and pads short strips.
/// @throw Error(kInput) if the file is no TIFF, a page or one of its values lies outside the file,
///        strips or tiles are missing or too short, or the chain of pages is a ring
TiffPages walkTiff(const std::filesystem::path& file);

}  // namespace deltasplat
