// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace deltasplat {

/// Elements of a data set or sequence item by tag (group << 16 | element); a tag's first one
/// counts.
struct DicomItem {
    bool bigEndian = false;
    /// Values of at most 1 KiB, and longer tables of numbers.
    std::map<std::uint32_t, std::string> values;
    /// Items of sequences that give the meaning of numbers or the places of frames.
    std::map<std::uint32_t, std::vector<DicomItem>> sequences;

    /// Returns a text without its padding; empty if the element is missing.
    std::string text(std::uint32_t tag) const;
    /// Returns a 2-byte number, or `missing`.
    int number(std::uint32_t tag, int missing) const;
    /// Returns the numbers of a text "1\0\0"; none if one is no finite number or exceeds `most`.
    std::vector<double> decimals(std::uint32_t tag, double most) const;
    /// Returns an element's 2-byte numbers.
    std::vector<std::uint16_t> words(std::uint32_t tag) const;
    /// Returns an element's 8-byte numbers; none if one is not finite.
    std::vector<double> doubles(std::uint32_t tag) const;
    /// Returns a sequence's first item, or null.
    const DicomItem* first(std::uint32_t sequence) const;
};

struct DicomElements : DicomItem {
    std::string syntax;   ///< transfer syntax UID
    bool packed = false;  ///< the pixels are compressed
    /// The pixels' place: one piece, or if packed a table of offsets (maybe empty) and the pieces.
    struct Piece {
        std::uint64_t start = 0;
        std::uint64_t length = 0;
    };
    std::vector<Piece> pixels;
    bool pixelWords = true;  ///< pixels are 2-byte words, so byte order matters

    std::uint64_t pixelBytes() const;
    /// Whether the file is a table of contents, usually named DICOMDIR.
    bool isContents() const { return text(0x00020002) == "1.2.840.10008.1.3.10"; }
};

/// Walks a DICOM file's elements. Tolerates deviations that other readers accept: any order, group
/// 2 twice, bytes after the last element, a missing header, value types that are present or absent
/// against the header. Of a table of contents only the header is walked.
/// @throw Error(kInput) if an element leaves the file or its enclosing element and is not padding
///        after the pixels; Error(kFailed) if memory is short
DicomElements walkDicom(const std::filesystem::path& file);

}  // namespace deltasplat
