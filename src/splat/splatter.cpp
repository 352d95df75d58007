// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9, and Lee Westover, "Footprint Evaluation for Volume Rendering", 1990, for the sheet.
#include "splat/splatter.h"

namespace deltasplat {
namespace {

using Way = std::variant<StampSplatter, TileSplatter>;

Way wayFor(const SplatInput& input, const SheetLayout& largest) {
    if (TileWeights::fits(input.footprint)) {
        return Way(std::in_place_type<TileSplatter>, input, largest);
    }
    return Way(std::in_place_type<StampSplatter>, input, largest);
}

}  // namespace

Splatter::Splatter(const SplatInput& input, const SheetLayout& largest)
    : way_(wayFor(input, largest)) {}

void Splatter::run(const Slab& slab, const SheetLayout& layout,
                   const std::function<void(int, const Sheet&)>& eachSlice) {
    std::visit(
        [&](auto& way) {
            way.setLayout(layout);
            for (int i = 0; i < slab.sliceCount; ++i) {
                way.splat(slab.firstSlice + i, slab.whole);
                eachSlice(slab.firstSlice + i, way.sheet());
            }
            way.clear();
        },
        way_);
}

double Splatter::bytes(const SheetLayout& layout) {
    // The sheet, and what is shown: half the sheet's size at most, or 2 bytes a voxel.
    const double voxels = 64.0 * layout.blocks.x * layout.blocks.y;
    return 1.5 * double(layout.bytes()) + (2 + 0.25) * voxels;
}

}  // namespace deltasplat
