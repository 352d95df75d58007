// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9, and Lee Westover, "Footprint Evaluation for Volume Rendering", 1990, for the sheet.
#include "splat/splatter.h"

namespace deltasplat {
namespace {

using Way = std::variant<StampSplatter, TileSplatter>;

// Where a block changes in fewer places a slice on average, summing tiles takes longer than
// stamping. What is splatted anew for each slice has to be cleared as well, which tiles do by the
// way: of that there may be little.
constexpr double kFewChanges = 12;
constexpr double kMostWhole = 0.1;

bool hasFewChanges(const PackedDeltas& deltas) {
    std::uint64_t stamps = 0;
    std::uint64_t whole = 0;
    for (const PlannedSlab& slab : deltas.slabs) {
        stamps += slab.stamps();
        if (slab.whole) whole += slab.stamps();
    }
    return double(stamps) < kFewChanges * double(deltas.words.size()) &&
           double(whole) <= kMostWhole * double(stamps);
}

// Both ways give the same integers.
Way wayFor(const SplatInput& input, const SheetLayout& largest) {
    if (TileWeights::fits(input.footprint) && !hasFewChanges(input.deltas))
        return Way(std::in_place_type<TileSplatter>, input, largest);
    return Way(std::in_place_type<StampSplatter>, input, largest);
}

}  // namespace

Splatter::Splatter(const SplatInput& input, const SheetLayout& largest)
    : way_(wayFor(input, largest)) {}

void Splatter::begin(const SheetLayout& layout) {
    std::visit([&](auto& way) { way.setLayout(layout); }, way_);
}

const Sheet& Splatter::splat(int slice, bool whole, int firstRow, int lastRow) {
    return std::visit(
        [&](auto& way) -> const Sheet& {
            way.splat(slice, whole, firstRow, lastRow);
            return way.sheet();
        },
        way_);
}

void Splatter::end() {
    std::visit([](auto& way) { way.clear(); }, way_);
}

double Splatter::bytes(const SheetLayout& layout) {
    // The sheet, and what is shown: half the sheet's size at most, or 2 bytes a voxel.
    const double voxels = 64.0 * layout.blocks.x * layout.blocks.y;
    return 1.5 * double(layout.bytes()) + (2 + 0.25) * voxels;
}

}  // namespace deltasplat
