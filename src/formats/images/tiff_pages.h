// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace deltasplat {

/// Where the table of one page of a TIFF lies, and how to take it for the only page: the header
/// names it as the first, and it names no next one.
struct TiffPage {
    std::uint64_t table = 0;      ///< place of its table
    std::uint64_t nextField = 0;  ///< place of the number that names the next page's table
    bool whiteIsZero = false;     ///< smaller values are meant to be shown brighter
    bool isReduced = false;       ///< a thumbnail, a smaller copy or a mask of another page
    /// Place of the two bytes that say that numbers are those of a palette's colours; 0 if they are
    /// not.
    std::uint64_t paletteField = 0;
    /// Where the pixels begin, and how many bytes they take, if these lie as they are in memory:
    /// not packed, row by row, whole bytes, the samples of a pixel together. Else 0.
    std::uint64_t pixels = 0;
    std::uint64_t pixelBytes = 0;
    std::uint64_t roomBytes = 0;  ///< from there to what else the page has in the file, or its end
};

/// The pages of a TIFF or BigTIFF.
struct TiffPages {
    bool bigEndian = false;
    int offsetBytes = 4;           ///< of a place in the file: 4, or 8 in a BigTIFF
    std::uint64_t firstField = 4;  ///< place of the number that names the first page's table
    std::vector<TiffPage> pages;   ///< in order, at least one
    // Of the first page:
    std::string description;            ///< what the program that wrote it says of it
    int samples = 1;                    ///< values of a pixel
    glm::dvec2 pixelsPerUnit{0.0};      ///< 0: it does not say
    int resolutionUnit = 2;             ///< 1: none, 2: inch, 3: centimetre
    std::uint64_t metaMorphPlanes = 0;  ///< planes of a stack of MetaMorph's; 0 if it is none
};

/// Follows the chain of pages, in time that grows with their number, and holds what each says about
/// its pixels against the file: libtiff ends quietly at the first page that it cannot read, and
/// fills up strips that are too short.
/// @throw Error(kInput) if it is no TIFF, or a page or any of its values is not in the file, or
///        strips or tiles are missing or too short for what they are said to hold, or pages follow
///        each other in a ring
TiffPages walkTiff(const std::filesystem::path& file);

}  // namespace deltasplat
