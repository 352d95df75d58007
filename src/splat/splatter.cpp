// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9, and Lee Westover, "Footprint Evaluation for Volume Rendering", 1990, for the sheet.
#include "splat/splatter.h"

namespace deltasplat {

// Both ways give the same integers.
void Splatter::begin(const PlannedSlab& slab, const SheetLayout& layout) {
    whole_ = slab.whole;
    // What is splatted anew for each slice has to be cleared as well, which tiles do by the way.
    stamping_ = !TileSplatter::fits(input_.footprint) ||
                (!slab.whole && slab.changesFewerThan(
                                    TileSplatter::leastChanges(input_.footprint, layout.channels)));
    if (stamping_ && !stamps_) stamps_.emplace(input_, largest_, sheet_);
    if (!stamping_ && !tiles_) tiles_.emplace(input_, largest_, sheet_);
    sheet_.setLayout(layout);
    withWay([&](auto& way) { way.setLayout(layout); });
}

const Sheet& Splatter::splat(int slice, int firstRow, int lastRow) {
    withWay([&](auto& way) { way.splat(slice, whole_, firstRow, lastRow); });
    return sheet_;
}

void Splatter::end() {
    withWay([](auto& way) { way.clear(); });
}

double Splatter::bytes(const SplatInput& input, const SheetLayout& layout) {
    // The sheet, and what each way shows: half the sheet's size at most, or 2 bytes a voxel.
    const double voxels = 64.0 * layout.blocks.x * layout.blocks.y;
    const double tiles = TileSplatter::fits(input.footprint) ? 0.5 * double(layout.bytes()) : 0;
    return double(layout.bytes()) + tiles + 2 * (2 + 0.25) * voxels;
}

}  // namespace deltasplat
