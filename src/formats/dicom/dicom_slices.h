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

/// How the numbers of a slice are stored: which bits of a cell are theirs.
struct DicomBits {
    int allocated = 16;  ///< of a cell: 8, 16 or 32
    int stored = 16;     ///< of a number
    int high = 15;       ///< its highest bit
    bool isSigned = false;

    std::int64_t least() const { return isSigned ? -(std::int64_t{1} << (stored - 1)) : 0; }
    std::int64_t most() const { return (std::int64_t{1} << (stored - (isSigned ? 1 : 0))) - 1; }
};

/// Returns the number that the lowest `bits` bits are.
inline std::int64_t numberOfBits(std::uint64_t cell, int bits, bool isSigned) {
    const std::uint64_t number = cell & ((std::uint64_t{1} << bits) - 1);
    const bool negative = isSigned && (number >> (bits - 1) & 1) != 0;
    return std::int64_t(number) - (negative ? std::int64_t{1} << bits : 0);
}

/// The smallest and the largest value that stored numbers can have, and whether all are whole.
struct DicomRange {
    double low = 0;
    double high = 0;
    bool isWhole = true;
    bool operator==(const DicomRange&) const = default;
};

/// What the stored numbers of a slice mean.
struct DicomMeaning {
    /// Stored numbers from the first to the last.
    struct Span {
        std::int64_t first = std::numeric_limits<std::int64_t>::min();
        std::int64_t last = std::numeric_limits<std::int64_t>::max();
        bool contains(std::int64_t number) const { return number >= first && number <= last; }
    };
    /// Values of stored numbers from the first on; those beyond the ends have the ends' values.
    struct Table {
        std::int64_t first = 0;
        std::vector<double> values;
        DicomRange range;  ///< of the values
        bool operator==(const Table&) const = default;
    };
    std::optional<Span> padding;   ///< numbers that fill a picture up: nothing is there
    std::optional<Span> measured;  ///< others mean nothing
    Rescale rescale;
    std::shared_ptr<const Table> table;  ///< takes the rescale's place

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

/// What elements say of one frame: those that it has of its own, that all frames share, or that the
/// file has.
struct DicomFrame {
    const DicomItem* file = nullptr;
    const DicomItem* shared = nullptr;
    const DicomItem* own = nullptr;

    /// Returns the item of a group of functions, by its sequence; the file itself if there is none.
    const DicomItem& group(std::uint32_t sequence) const;
};

/// What users may not expect of the values of slices, each said once.
class DicomNotes {
  public:
    /// @param ofSeveral  what is said in place of lines that differ from slice to slice
    void add(const std::string& line, const std::string& ofSeveral = "");
    std::vector<std::string> lines() const;

  private:
    // By what is said of several slices; empty where they differ.
    std::vector<std::pair<std::string, std::string>> lines_;
};

/// The table that was made last of one file: frames share what is one item's, or equal.
struct DicomLastTable {
    const DicomItem* item = nullptr;
    std::shared_ptr<const DicomMeaning::Table> table;
};

/// Returns what the stored numbers of a frame mean.
/// @param where  the file, for messages
/// @param last   of the file's frames before
/// @param notes  what users may not expect of it
/// @throw Error(kInput) if a slope or a table is none; Error(kFailed) if memory is short
DicomMeaning meaningOf(const std::string& where, const DicomFrame& frame, const DicomBits& bits,
                       DicomLastTable& last, DicomNotes& notes);

DicomRange rangeOf(const DicomBits& bits, const DicomMeaning& meaning);

/// How the picture is stored that a slice is, or is a part of.
struct DicomPixels {
    std::string syntax;  ///< DICOM's name for how the file is written
    bool bigEndian = false;
    bool packed = false;
    bool words = true;
    using Piece = DicomElements::Piece;
    std::vector<Piece> pieces;  ///< without a table of offsets
    Piece element;              ///< that the piece is a part of, if they are not packed
    int columns = 0;
    int rows = 0;
    DicomBits bits;
};

/// What the header of one DICOM slice says, checked.
struct DicomSlice {
    std::filesystem::path file;
    int frame = 0;  ///< of several in the file, from 1 on; 0 if it is the only one
    int columns = 0;
    int rows = 0;
    int left = 0;  ///< of its first voxel in the picture
    int top = 0;
    DicomPixels pixels;
    DicomMeaning meaning;
    glm::dvec3 position{0.0};     ///< of the centre of the first voxel; millimetres, LPS
    glm::dvec3 alongRow{0.0};     ///< from one column to the next
    glm::dvec3 alongColumn{0.0};  ///< from one row to the next
    double thickness = 1;         ///< along the normal; what a single slice goes by

    glm::dvec3 normal() const;
    /// Returns its file's name, with the folders below the input, and the frame.
    std::string name(const std::filesystem::path& input) const;
};

/// The slices of one volume, in order, and where they lie.
struct DicomVolume {
    std::vector<DicomSlice> slices;  ///< along the normal
    glm::dmat4 worldFromIndex{1.0};
};

/// Sorts the slices of one series by their places.
/// @param input  the folder, or a file in it, for messages
/// @throw Error(kInput) if they are of several sizes or directions, or unevenly spaced
DicomVolume arrangeSlices(const std::filesystem::path& input, std::vector<DicomSlice> slices);

/// Whether a file is a mosaic: a picture that slices are laid out in, row by row.
bool isMosaic(const DicomElements& elements);

/// Returns the slices of a mosaic.
/// @param picture  the mosaic as one slice
/// @param notes    what users may not expect of it
/// @throw Error(kInput) if it does not say how many there are, or they do not fill it
std::vector<DicomSlice> slicesOfMosaic(const DicomElements& elements, const DicomSlice& picture,
                                       DicomNotes& notes);

}  // namespace deltasplat
