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

/// Returns numbers as text, separated by single spaces; each is the shortest that reads back equal.
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

/// Reads the text of listText; returns nothing for any other text.
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

/// Metadata of a delta grid, specified in docs/delta-grid.md.
struct DeltaHeader {
    /// Versions of deltas as voxels and of packed deltas.
    static constexpr int kVersion = 6;
    static constexpr int kPackedVersion = 7;

    int version = kVersion;
    int sliceAxis = 2;
    int keyInterval = 8;
    IndexBox box;  ///< in the source's index space
    /// If set, slots are ExactSlots, and `book` and `codeCount` are meaningless.
    std::optional<ExactValues> exact;
    CodeBook book;
    int codeCount = kCodeCount;  ///< codes are below this
    std::string sourceType;      ///< as Volume::type
    std::string sourceTree;  ///< value type of the source's OpenVDB tree; empty: not from a .vdb
    std::string sourceMap;   ///< type of the source's transform; empty: not from a .vdb
    std::string space;       ///< as Volume::space
    double background = 0;
    bool restActive = false;  ///< voxels without deltas are active (a volume without empty places)
    std::vector<double> inactiveValues;     ///< of slots from kSlotCount, or firstInactive(), on
    std::uint64_t active = 0;               ///< active voxels of the source
    std::vector<std::uint64_t> slabDeltas;  ///< number of deltas per slab
    double tolerance = 0;
    double toleranceValue = 0;
    double maxError = 0;

    std::string bookName() const;
    std::uint64_t deltas() const;  ///< sum of all slabs
    bool isWide() const { return exact && *exact != ExactValues::kFloat32; }
    /// Whether the voxels are the words of a stream (delta_stream.h) instead of deltas.
    bool isPacked() const { return version == kPackedVersion; }
};

/// Prefix of the source grid's own metadata in a delta grid.
inline constexpr const char* kSourcePrefix = "source:";

/// Whether a grid is a delta grid of any version.
bool isDeltaGrid(const TreeGrid& grid);
bool isDeltaGrid(const std::string& valueType, const VdbMetadata& metadata);

/// Adds the header to a grid's metadata; leaves out the entries of an empty grid of floats.
void putDeltaHeader(const DeltaHeader& header, VdbMetadata& metadata);

/// Reads a delta grid's header and checks all that needs no voxels.
/// @throw Error(kInput) at the first entry that is missing, of another type or out of range
DeltaHeader takeDeltaHeader(const VdbMetadata& metadata, const std::string& where);

/// Whether a volume was read from deltas of its codes: then the codes are exact whatever the book,
/// and nothing else exists. Otherwise `source`, if any, has the values.
inline bool isOfCodes(const Volume& volume) {
    return volume.origin() && volume.origin()->codeBook == volume.codeBook().name();
}

}  // namespace deltasplat
