// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9, and Lee Westover, "Footprint Evaluation for Volume Rendering", 1990, for the sheet.
#include "splat/digit_splatter.h"

namespace deltasplat {

// All ways give the same integers.
void DigitSplatter::begin(const PlannedSlab& slab, const SheetLayout& layout) {
    whole_ = slab.whole;
    if (PixelSplatter::fits(input_.footprint)) {
        sheet_.setLayout(layout);
        if (!pixels_) pixels_.emplace(input_, largest_, sheet_, digit_, hasLow_);
        return pixels_->setLayout(layout);
    }
    // What is splatted anew for each slice has to be cleared as well, and a low digit be added,
    // both of which tiles do by the way: that is more than small stamps are worth.
    const bool suitsStamps = TileSplatter::isWide(input_.footprint) || (!slab.whole && !hasLow_);
    stamping_ = !TileSplatter::fits(input_.footprint) || (suitsStamps && isFew(slab));
    sheet_.setLayout(layout);
    if (stamping_) {
        if (!stamps_) stamps_.emplace(input_, largest_, sheet_, digit_);
        stamps_->setLayout(layout);
    } else {
        if (!tiles_) {
            const bool withLow = hasLow_ && TileSplatter::addsLow(input_.footprint);
            tiles_.emplace(input_, largest_, sheet_, digit_, withLow);
        }
        tiles_->setLayout(layout);
    }
}

bool DigitSplatter::isFew(const PlannedSlab& slab) const {
    // Then empty ones are stamped as well.
    if (input_.stampEmptyVoxels && digit_.plane == 0 && !digit_.low) return false;
    return isFew_.value_or(false) ||
           slab.stamps() < TileSplatter::leastStamps(input_.footprint) * slab.stampedWords();
}

const Sheet& DigitSplatter::splat(int slice, const NeededPixels& needed, const Sheet* low) {
    if (pixels_) {
        pixels_->splat(slice, whole_, needed);
    } else if (stamping_) {
        stamps_->splat(slice, whole_, needed);
    } else {
        tiles_->splat(slice, whole_, needed, low);
    }
    return sheet_;
}

void DigitSplatter::end() {
    if (pixels_) {
        pixels_->clear();
    } else if (stamping_) {
        stamps_->clear();
    } else {
        tiles_->clear();
    }
}

double DigitSplatter::bytes(const SplatInput& input, const SheetLayout& layout, bool hasLow) {
    if (PixelSplatter::fits(input.footprint))
        return double(layout.bytes()) + PixelSplatter::bytes(input, layout);
    const double blocks = double(layout.blocks.x) * layout.blocks.y;
    // What stamps show, which of them wait, and their list as it grows.
    const double shownBytes = input.colors.own() ? sizeof(ClassTable::Color) : sizeof(ClassIndex);
    const double ofBlock = 64 * shownBytes + 3 * sizeof(BlockStamps) + SliceBlocks::kBytesOfBlock;
    const bool withLow = hasLow && TileSplatter::addsLow(input.footprint);
    const double tiles = TileSplatter::fits(input.footprint)
                             ? TileSplatter::bytes(input.footprint, layout, withLow)
                             : 0;
    return double(layout.bytes()) + ofBlock * blocks + tiles;
}

}  // namespace deltasplat
