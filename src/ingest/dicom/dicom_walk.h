// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace deltasplat {

/// What stands in a DICOM file outside of its sequences.
struct DicomElements {
    std::string syntax;  ///< the name of how the file is written
    bool bigEndian = false;
    bool packed = false;  ///< the pixels are compressed
    /// Values of at most 1 KiB, by group << 16 | element.
    std::map<std::uint32_t, std::string> values;
    /// Where the pixels lie in the file: in one piece, or if packed as a table of offsets, which
    /// may be empty, and the packed pieces.
    struct Piece {
        std::uint64_t start = 0;
        std::uint64_t length = 0;
    };
    std::vector<Piece> pixels;
    bool pixelWords = true;  ///< the pixels are words of two bytes, of which the order is one

    std::uint64_t pixelBytes() const;

    /// Returns a text without what fills it up; empty if the file has no such element.
    std::string text(std::uint32_t tag) const;
    /// Returns a number of two bytes, or `missing`.
    int number(std::uint32_t tag, int missing) const;
};

/// Walks the elements of a DICOM file, so that what GDCM reads afterwards holds together: GDCM ends
/// the process where a length or a type is impossible, and makes up pixels that are cut off.
/// @throw Error(kInput) if an element does not lie within the file, or within the one around it
DicomElements walkDicom(const std::filesystem::path& file);

}  // namespace deltasplat
