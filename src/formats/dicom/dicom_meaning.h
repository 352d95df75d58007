// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

}  // namespace deltasplat
