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
      plane_(plane),
      hasLow_(hasLow(input, plane)),
      high_(input, largest, {plane, false}, hasLow_) {}

void PlaneSplatter::begin(const PlannedSlab& slab, const SheetLayout& layout) {
    high_.begin(slab, layout);
    if (!sumsDigits()) return;
    if (!low_) {
        low_.emplace(input_, largest_, DigitPlace{plane_, true}, false);
        sum_.emplace(largest_, input_.memory);
    }
    low_->begin(slab, layout);
    sum_->setLayout(layout);
}

const Sheet& PlaneSplatter::splat(int slice, const NeededPixels& needed) {
    const Sheet& high = high_.splat(slice, needed);
    if (!sumsDigits()) return high;
    sum_->addDigits(high, low_->splat(slice, needed), needed.firstRow, needed.lastRow);
    return *sum_;
}

void PlaneSplatter::end() {
    high_.end();
    if (!sumsDigits()) return;
    low_->end();
    sum_->clear();
}

double PlaneSplatter::bytes(const SplatInput& input, const SheetLayout& layout, int plane) {
    const bool addsLow = hasLow(input, plane);
    const double high = DigitSplatter::bytes(input, layout, addsLow);
    if (!addsLow || !TileSplatter::isWide(input.footprint)) return high;
    return high + DigitSplatter::bytes(input, layout, false) + double(layout.bytes());
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

}  // namespace deltasplat
