// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/ingest/slot.h"
#include "deltasplat/ingest/volume.h"
#include "formats/delta/exact_slots.h"
#include "volume/tree_grid.h"
#include "volume/vdb_metadata.h"

namespace deltasplat {

/// Returns numbers as text with one space between, each the shortest that reads back the same.
template <typename Number>
std::string listText(const std::vector<Number>& numbers) {
    std::string text;
    for (const Number number : numbers) {
        char digits[32];
        if (!text.empty()) text += ' ';
        text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
    }
    return text;
}

/// Reads what listText writes; empty if the text is anything else.
template <typename Number>
std::optional<std::vector<Number>> parseList(const std::string& text) {
    std::vector<Number> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at != end) {
        Number number{};
        const auto [next, problem] = std::from_chars(at, end, number);
        if (problem != std::errc() || (next != end && (*next != ' ' || next + 1 == end))) return {};
        numbers.push_back(number);
        at = next == end ? end : next + 1;
    }
    return numbers;
}

/// What a delta grid's metadata says; docs/delta-grid.md specifies it.
struct DeltaHeader {
    /// Of deltas as voxels.
    static constexpr int kVersion = 6;
    /// Of packed deltas.
    static constexpr int kPackedVersion = 7;

    int version = kVersion;
    int sliceAxis = 2;
    int keyInterval = 8;
    IndexBox box;  ///< in the source's index space
    /// Where there is one, slots are ExactSlots, and neither `book` nor `codeCount` means anything.
    std::optional<ExactValues> exact;
    CodeBook book;
    int codeCount = kCodeCount;  ///< codes are below this
    std::string sourceType;      ///< as Volume::type
    std::string sourceTree;  ///< value type of the source's OpenVDB tree; empty: not from a .vdb
    std::string sourceMap;   ///< type of the source's transform; empty: not from a .vdb
    std::string space;       ///< as Volume::space
    double background = 0;
    bool restActive = false;  ///< what no delta speaks of is active (a volume without empty places)
    std::vector<double> inactiveValues;     ///< of slots from kSlotCount, or firstInactive, on
    std::uint64_t active = 0;               ///< active voxels of the source
    std::vector<std::uint64_t> slabDeltas;  ///< deltas of each slab
    double tolerance = 0;
    double toleranceValue = 0;
    double maxError = 0;

    std::string bookName() const;
    std::uint64_t deltas() const;  ///< of all slabs together
    /// Whether deltas take 64 bits.
    bool isWide() const { return exact && *exact != ExactValues::kFloat32; }
    /// Whether the grid's voxels are words of a stream (delta_stream.h) in place of deltas.
    bool isPacked() const { return version == kPackedVersion; }
};

/// Names of the source grid's own metadata in a delta grid begin with this.
inline constexpr const char* kSourcePrefix = "source:";

/// Returns whether a grid is a delta grid of any version.
bool isDeltaGrid(const TreeGrid& grid);
/// Returns the same by a grid's value type ("int32", "int64") and metadata.
bool isDeltaGrid(const std::string& valueType, const VdbMetadata& metadata);

/// Adds the header to a grid's metadata, but for the entries of an empty grid of floats.
void putDeltaHeader(const DeltaHeader& header, VdbMetadata& metadata);

/// Reads a delta grid's header and checks everything in it that can be checked without its voxels.
/// @throw Error(kInput) at the first entry that is missing, of another type or out of range
DeltaHeader takeDeltaHeader(const VdbMetadata& metadata, const std::string& where);

/// Whether a volume has been read from deltas of its codes: then the codes are all that there is,
/// and exact whatever their book was. Otherwise the values are those of `source`, if any.
inline bool isOfCodes(const Volume& volume) {
    return volume.origin && volume.origin->codeBook == volume.codeBook.name();
}

}  // namespace deltasplat
