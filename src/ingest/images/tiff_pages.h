// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace deltasplat {

/// Where the table of one page of a TIFF lies, and how to take it for the only page: the header
/// names it as the first, and it names no next one.
struct TiffPage {
    std::uint64_t table = 0;      ///< place of its table
    std::uint64_t nextField = 0;  ///< place of the number that names the next page's table
    bool whiteIsZero = false;     ///< smaller values are meant to be shown brighter
};

/// The pages of a TIFF or BigTIFF.
struct TiffPages {
    bool bigEndian = false;
    int offsetBytes = 4;           ///< of a place in the file: 4, or 8 in a BigTIFF
    std::uint64_t firstField = 4;  ///< place of the number that names the first page's table
    std::vector<TiffPage> pages;   ///< in order, at least one
};

/// Follows the chain of pages, in time that grows with their number, and holds what each says about
/// its pixels against the file: libtiff ends quietly at the first page that it cannot read, and
/// fills up strips that are too short.
/// @throw Error(kInput) if it is no TIFF, or a page or any of its values is not in the file, or
///        strips or tiles are missing or too short, or pages follow each other in a ring
TiffPages walkTiff(const std::filesystem::path& file);

}  // namespace deltasplat
