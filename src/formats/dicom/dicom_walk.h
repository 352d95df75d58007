// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace deltasplat {

/// The elements of a data set, or of an item of a sequence. Tags are group << 16 | element; of two
/// elements with one tag the first counts.
struct DicomItem {
    bool bigEndian = false;
    /// Values of at most 1 KiB, and longer ones that are tables of numbers.
    std::map<std::uint32_t, std::string> values;
    /// The items of sequences that say what numbers mean, or where frames lie.
    std::map<std::uint32_t, std::vector<DicomItem>> sequences;

    /// Returns a text without what fills it up; empty if there is no such element.
    std::string text(std::uint32_t tag) const;
    /// Returns a number of two bytes, or `missing`.
    int number(std::uint32_t tag, int missing) const;
    /// Returns the numbers of an element that is text, "1\0\0"; none if one of them is no finite
    /// number, or beyond `most`.
    std::vector<double> decimals(std::uint32_t tag, double most) const;
    /// Returns the numbers of two bytes that an element holds.
    std::vector<std::uint16_t> words(std::uint32_t tag) const;
    /// Returns the numbers of eight bytes that an element holds, none if one is not finite.
    std::vector<double> doubles(std::uint32_t tag) const;
    /// Returns the first item of a sequence; null if there is none.
    const DicomItem* first(std::uint32_t sequence) const;
};

/// What stands in a DICOM file.
struct DicomElements : DicomItem {
    std::string syntax;   ///< the name of how the file is written
    bool packed = false;  ///< the pixels are compressed
    /// Where the pixels lie in the file: in one piece, or if packed as a table of offsets, which
    /// may be empty, and the packed pieces.
    struct Piece {
        std::uint64_t start = 0;
        std::uint64_t length = 0;
    };
    std::vector<Piece> pixels;
    bool pixelWords = true;  ///< the pixels are words of two bytes, of which the order is one

    std::uint64_t pixelBytes() const;
    /// Whether the file is a table of contents, as DICOMDIR is under that name.
    bool isContents() const { return text(0x00020002) == "1.2.840.10008.1.3.10"; }
};

/// Walks the elements of a DICOM file. What others read is read: elements in any order, group 2
/// twice, bytes behind the last element, a data set without its header, types of values where the
/// header says that there are none, or none where it says that there are.
/// Of a table of contents only the header is walked.
/// @throw Error(kInput) if an element does not lie within the file, or within the one around it,
/// and
///        is not what fills the file up behind the pixels; Error(kFailed) if memory is short
DicomElements walkDicom(const std::filesystem::path& file);

}  // namespace deltasplat
