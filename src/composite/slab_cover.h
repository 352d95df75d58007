// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "composite/layer.h"
#include "splat/sheet_cover.h"

namespace deltasplat {

/// Adds the cells in which a layer is opaque everywhere, its opacity 1 to the last bit: whatever is
/// put behind it there changes no bit, for it is multiplied by 0.
/// @return whether there are any that were not covered
bool addCovered(const Layer& layer, CoveredCells& cells);

/// What of the slices of a slab is covered and need not be made: by the slabs before it, and by the
/// slab's own slices, from the front on. What is covered changes no bit of the picture
/// (addCovered). To be asked for one slice after the other.
class SlabCover {
  public:
    /// @param before  what the slabs before cover
    /// @param layer   the slab's own, whose rows of `before` nobody else changes; it must outlive
    ///                this
    SlabCover(const BasePlane& plane, int lastSlice, std::shared_ptr<const CoveredCells> before,
              const Layer& layer)
        : plane_(plane), lastSlice_(lastSlice), layer_(layer), cells_(std::move(before)) {}

    /// Whether nothing has to be made.
    bool all() const { return cells_->all(); }
    /// Returns what of the next slice has to be made; valid until the one behind it.
    /// @param read  what the plane reads of it
    NeededPixels next(const SheetReading& reading, const SheetBox& read, const SheetLayout& layout);
    /// Says over how many pixels of the layer compositing that slice went.
    void add(std::size_t pixels) { pixels_ += pixels; }

  private:
    void look();

    const BasePlane& plane_;
    int lastSlice_;
    const Layer& layer_;
    std::shared_ptr<const CoveredCells> cells_;
    std::size_t pixels_ = 0;     // composited since the last look
    std::size_t between_ = 128;  // pixels a cell, from a look to the next
    int slices_ = 0;             // since fromNowOn_ was found
    SheetCover ofSlice_;
    SheetCover fromNowOn_;
};

}  // namespace deltasplat
