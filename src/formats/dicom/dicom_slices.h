// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/dense/rescale.h"
#include "formats/dicom/dicom_walk.h"

namespace deltasplat {

/// The bits of a cell that hold a slice's number.
struct DicomBits {
    int allocated = 16;  ///< bits per cell: 8, 16 or 32
    int stored = 16;     ///< bits per number
    int high = 15;       ///< the number's highest bit
    bool isSigned = false;

    std::int64_t least() const { return isSigned ? -(std::int64_t{1} << (stored - 1)) : 0; }
    std::int64_t most() const { return (std::int64_t{1} << (stored - (isSigned ? 1 : 0))) - 1; }
};

/// Returns the number in the lowest `bits` bits.
inline std::int64_t numberOfBits(std::uint64_t cell, int bits, bool isSigned) {
    const std::uint64_t number = cell & ((std::uint64_t{1} << bits) - 1);
    const bool negative = isSigned && (number >> (bits - 1) & 1) != 0;
    return std::int64_t(number) - (negative ? std::int64_t{1} << bits : 0);
}

/// The range of values that stored numbers can have, and whether all are integers.
struct DicomRange {
    double low = 0;
    double high = 0;
    bool isWhole = true;
    bool operator==(const DicomRange&) const = default;
};

struct DicomMeaning {
    struct Span {
        std::int64_t first = std::numeric_limits<std::int64_t>::min();
        std::int64_t last = std::numeric_limits<std::int64_t>::max();
        bool contains(std::int64_t number) const { return number >= first && number <= last; }
    };
    /// Values for stored numbers from `first` on. Numbers beyond an end take the value at that end.
    struct Table {
        std::int64_t first = 0;
        std::vector<double> values;
        DicomRange range;  ///< of the values
        bool operator==(const Table&) const = default;
    };
    std::optional<Span> padding;   ///< numbers that pad the picture: no data there
    std::optional<Span> measured;  ///< numbers outside of it mean nothing
    Rescale rescale;
    std::shared_ptr<const Table> table;  ///< replaces the rescale

    double valueOf(std::int64_t number) const {
        if (!table) return rescale.slope * double(number) + rescale.intercept;
        const std::int64_t last = table->first + std::int64_t(table->values.size()) - 1;
        const std::int64_t inside = number < table->first ? table->first
                                    : number > last       ? last
                                                          : number;
        return table->values[std::size_t(inside - table->first)];
    }
    bool mayBeNothing() const { return padding || measured; }
};

/// The elements that apply to one frame: its own, those shared by all frames, and the file's.
struct DicomFrame {
    const DicomItem* file = nullptr;
    const DicomItem* shared = nullptr;
    const DicomItem* own = nullptr;

    /// Returns the frame's item of a functional group, found by its sequence; otherwise the file.
    const DicomItem& group(std::uint32_t sequence) const;
};

/// Surprising facts about a series' values for the user, each reported once.
class DicomNotes {
  public:
    /// @param ofSeveral  replaces lines that differ from slice to slice
    void add(const std::string& line, const std::string& ofSeveral = "");
    std::vector<std::string> lines() const;

  private:
    // Pairs of the line for several slices and the single line, which is empty if lines differ.
    std::vector<std::pair<std::string, std::string>> lines_;
};

/// The latest table made for a file. Frames with the same item or equal tables share it.
struct DicomLastTable {
    const DicomItem* item = nullptr;
    std::shared_ptr<const DicomMeaning::Table> table;
};

/// @param last   from the file's previous frames
/// @param notes  receives surprises for the user
/// @throw Error(kInput) if a slope or a table is invalid; Error(kFailed) if memory is short
DicomMeaning meaningOf(const std::string& where, const DicomFrame& frame, const DicomBits& bits,
                       DicomLastTable& last, DicomNotes& notes);

DicomRange rangeOf(const DicomBits& bits, const DicomMeaning& meaning);

/// Storage of the picture that the slice fills, wholly or in part.
struct DicomPixels {
    std::string syntax;  ///< transfer syntax UID
    bool bigEndian = false;
    bool packed = false;
    bool words = true;
    using Piece = DicomElements::Piece;
    std::vector<Piece> pieces;  ///< without a table of offsets
    Piece element;              ///< the element that holds the pixels, if they are not packed
    int columns = 0;
    int rows = 0;
    DicomBits bits;
};

/// The checked header of one DICOM slice.
struct DicomSlice {
    std::filesystem::path file;
    int frame = 0;  ///< from 1 on, if the file has several frames; else 0
    int columns = 0;
    int rows = 0;
    int left = 0;  ///< first column in the picture
    int top = 0;
    DicomPixels pixels;
    DicomMeaning meaning;
    glm::dvec3 position{0.0};     ///< centre of the first voxel; millimetres, LPS
    glm::dvec3 alongRow{0.0};     ///< from one column to the next
    glm::dvec3 alongColumn{0.0};  ///< from one row to the next
    double thickness = 1;         ///< along the normal; the spacing of a single slice

    glm::dvec3 normal() const;
    /// Returns the file name with its folders below the input, and the frame.
    std::string name(const std::filesystem::path& input) const;
};

struct DicomVolume {
    std::vector<DicomSlice> slices;  ///< along the normal
    glm::dmat4 worldFromIndex{1.0};
};

/// Sorts the slices of one series by position. `input`: its folder or a file in it, for messages.
/// @throw Error(kInput) if slices differ in size or direction, or are unevenly spaced
DicomVolume arrangeSlices(const std::filesystem::path& input, std::vector<DicomSlice> slices);

/// Whether the file is a mosaic: one picture with slices side by side, row by row.
bool isMosaic(const DicomElements& elements);

/// @param picture  the mosaic as one slice
/// @param notes    receives surprises for the user
/// @throw Error(kInput) if the number of slices is missing, or the slices do not fill the mosaic
std::vector<DicomSlice> slicesOfMosaic(const DicomElements& elements, const DicomSlice& picture,
                                       DicomNotes& notes);

}  // namespace deltasplat
