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
    const double blocks = double(layout.blocks.x) * layout.blocks.y;
    // The classes that stamps show, and their list as it grows.
    const double stamps = blocks * (64 * sizeof(ClassIndex) + 3 * sizeof(BlockStamps));
    // The plane, which is at most half as large as the sheet, and two lists of blocks.
    const double tiles = 0.5 * double(layout.bytes()) + 48 * blocks;
    return double(layout.bytes()) + stamps + (TileSplatter::fits(input.footprint) ? tiles : 0);
}

}  // namespace deltasplat
