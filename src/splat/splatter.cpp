// SPDX-License-Identifier: Apache-2.0
#include "splat/splatter.h"

namespace deltasplat {

namespace {

bool hasLow(const SplatInput& input, int plane) {
    return !DigitPlace{plane, true}.of(input.colors.table()).colors.empty();
}

}  // namespace

PlaneSplatter::PlaneSplatter(const SplatInput& input, const SheetLayout& largest, int plane)
    : input_(input),
      largest_(largest),
      high_(input, largest, {plane, false}, hasLow(input, plane)) {
    if (hasLow(input, plane) && !DigitSplatter::addsLow(input.footprint))
        low_.emplace(input, largest, DigitPlace{plane, true}, false);
}

void PlaneSplatter::begin(const PlannedSlab& slab, const SheetLayout& layout) {
    if (low_) low_->begin(slab, layout);
    high_.begin(slab, layout);
    if (!sumsDigits()) return;
    if (!sum_) sum_.emplace(largest_, input_.memory);
    sum_->setLayout(layout);
}

const Sheet& PlaneSplatter::splat(int slice, const NeededPixels& needed) {
    if (!low_) return high_.splat(slice, needed);
    const Sheet& low = low_->splat(slice, needed);
    if (!sumsDigits()) return high_.splat(slice, needed, &low);
    const Sheet& high = high_.splat(slice, needed);
    sum_->addDigits(high, low, needed.firstRow, needed.lastRow);
    return *sum_;
}

void PlaneSplatter::end() {
    if (low_) low_->end();
    if (sumsDigits()) sum_->clear();
    high_.end();
}

double PlaneSplatter::bytes(const SplatInput& input, const SheetLayout& layout, int plane) {
    const bool isTwo = hasLow(input, plane);
    const double high = DigitSplatter::bytes(input, layout, isTwo);
    if (!isTwo || DigitSplatter::addsLow(input.footprint)) return high;
    return 2 * high + (TileSplatter::isWide(input.footprint) ? double(layout.bytes()) : 0);
}

Splatter::Splatter(const SplatInput& input, const SheetLayout& largest) : input_(input) {
    if (const WordColors* own = input.colors.own()) input_.lit = &lit_.emplace(input.deltas, *own);
    for (int plane = 0; plane < int(input.colors.table().planes.size()); ++plane)
        planes_.push_back(std::make_unique<PlaneSplatter>(input_, largest, plane));
    sheets_.resize(planes_.size());
}

void Splatter::begin(const PlannedSlab& slab, const SheetLayout& layout) {
    for (const auto& plane : planes_) plane->begin(slab, layout);
}

std::span<const Sheet* const> Splatter::splat(int slice, const NeededPixels& needed) {
    for (std::size_t p = 0; p < planes_.size(); ++p) sheets_[p] = &planes_[p]->splat(slice, needed);
    return sheets_;
}

void Splatter::end() {
    for (const auto& plane : planes_) plane->end();
}

double Splatter::bytes(const SplatInput& input, const SheetLayout& layout) {
    const int planes = int(input.colors.table().planes.size());
    double bytes = 0;
    if (input.colors.own())
        bytes += LitSlice::bytes(double(layout.blocks.x) * layout.blocks.y, planes);
    for (int plane = 0; plane < planes; ++plane)
        bytes += PlaneSplatter::bytes(input, layout, plane);
    return bytes;
}

// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9, and Lee Westover, "Footprint Evaluation for Volume Rendering", 1990, for the sheet.
// All splatters give the same integers.
void DigitSplatter::begin(const PlannedSlab& slab, const SheetLayout& layout) {
    whole_ = slab.whole;
    if (PixelSplatter::fits(input_.footprint)) {
        sheet_.setLayout(layout);
        if (!pixels_) pixels_.emplace(input_, largest_, sheet_, digit_, hasLow_);
        return pixels_->setLayout(layout);
    }
    // Small stamps do not pay if slices need clearing or low digits, which tiles do in passing.
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
    // Empty voxels are stamped as well.
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
    // Classes or colours shown by stamps, waiting changes, and the growing list of stamps.
    const double shownBytes = input.colors.own() ? sizeof(ClassTable::Color) : sizeof(ClassIndex);
    const double ofBlock = 64 * shownBytes + 3 * sizeof(BlockStamps) + SliceBlocks::kBytesOfBlock;
    const bool withLow = hasLow && TileSplatter::addsLow(input.footprint);
    const double tiles = TileSplatter::fits(input.footprint)
                             ? TileSplatter::bytes(input.footprint, layout, withLow)
                             : 0;
    return double(layout.bytes()) + ofBlock * blocks + tiles;
}

}  // namespace deltasplat
