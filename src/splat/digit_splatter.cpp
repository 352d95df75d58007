// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9, and Lee Westover, "Footprint Evaluation for Volume Rendering", 1990, for the sheet.
#include "splat/digit_splatter.h"

namespace deltasplat {

// Both ways give the same integers.
void DigitSplatter::begin(const PlannedSlab& slab, const SheetLayout& layout) {
    whole_ = slab.whole;
    const bool isFew =
        isFew_.value_or(false) || slab.stamps() < leastStamps() * slab.stampedWords();
    // What is splatted anew for each slice has to be cleared as well, and a low digit be added,
    // both of which tiles do by the way: that is more than small stamps are worth.
    const bool isWide = !TileWeights::fits(input_.footprint);
    stamping_ =
        !TileSplatter::fits(input_.footprint) || (isFew && (isWide || (!slab.whole && !addsLow_)));
    sheet_.setLayout(layout);
    if (stamping_) {
        if (!stamps_) stamps_.emplace(input_, largest_, sheet_, digit_);
        stamps_->setLayout(layout);
    } else {
        if (!tiles_) tiles_.emplace(input_, largest_, sheet_, digit_);
        tiles_->setLayout(layout);
    }
}

const Sheet& DigitSplatter::splat(int slice, const NeededPixels& needed, const Sheet* low) {
    if (stamping_) {
        stamps_->splat(slice, whole_, needed);
    } else {
        tiles_->splat(slice, whole_, needed, low);
    }
    return sheet_;
}

void DigitSplatter::end() {
    if (stamping_) {
        stamps_->clear();
    } else {
        tiles_->clear();
    }
}

double DigitSplatter::bytes(const SplatInput& input, const SheetLayout& layout) {
    const double blocks = double(layout.blocks.x) * layout.blocks.y;
    // What stamps show, which wait, and their list as it grows.
    const double shownBytes = input.colors.own() ? sizeof(ClassTable::Color) : sizeof(ClassIndex);
    const double stamps = blocks * (64 * shownBytes + 4 * sizeof(BlockStamps));
    // The plane, which is at most half as large as a sheet of one pixel a voxel, and two lists of
    // blocks.
    const double voxels = layout.voxelsPerPixel * layout.voxelsPerPixel;
    const double tiles = 0.5 * double(layout.bytes()) * voxels + 64 * blocks;
    const double shown = input.colors.table().oneDigit() ? 0 : sizeof(std::uint64_t) * blocks;
    return double(layout.bytes()) + stamps + shown +
           (TileSplatter::fits(input.footprint) ? tiles : 0);
}

}  // namespace deltasplat
