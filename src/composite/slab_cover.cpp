// SPDX-License-Identifier: Apache-2.0
#include "composite/slab_cover.h"

#include <algorithm>
#include <utility>

#include "composite/find_covered.h"

namespace deltasplat {
namespace {

// A look at a cell takes about as long as compositing two pixels. Looks that find something are
// worth a thirtieth of that time, and those that find nothing get rarer and rarer.
constexpr std::size_t kLeastBetween = 64;  // pixels a cell
constexpr std::size_t kMostBetween = 1024;
// What is covered from now on grows slowly.
constexpr int kSlicesBetween = 8;

}  // namespace

NeededPixels SlabCover::next(const SheetReading& reading, const SheetBox& read,
                             const SheetLayout& layout) {
    const glm::ivec2 size = cells_->size();
    const auto cells = std::size_t(size.x) * std::size_t(size.y);
    if (pixels_ >= between_ * cells) look();
    NeededPixels needed{read.min.y, read.max.y};
    if (!cells_->any()) return needed;
    if (slices_-- == 0) {
        fromNowOn_.set(*cells_, reading, readingOf(plane_, layout, lastSlice_), layout);
        slices_ = kSlicesBetween - 1;
    }
    ofSlice_.set(*cells_, reading, reading, layout);
    needed.cover = &ofSlice_;
    needed.fromNowOn = &fromNowOn_;
    return needed;
}

void SlabCover::look() {
    pixels_ = 0;
    slices_ = 0;
    auto cells = std::make_shared<CoveredCells>(*cells_);
    const bool isNew = addCovered(layer_, *cells);
    between_ = isNew ? kLeastBetween : std::min(2 * between_, kMostBetween);
    cells_ = std::move(cells);
}

}  // namespace deltasplat
