// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "splat/stamp_splatter.h"
#include "splat/tile_splatter.h"

namespace deltasplat {

/// Turns slabs into sheets, in the way that suits the footprint and how much changes. Holds what
/// that takes, to be used for one slab after the other; not thread-safe.
class Splatter {
  public:
    /// @param largest  of the layouts to come
    Splatter(const SplatInput& input, const SheetLayout& largest)
        : input_(input), largest_(largest), sheet_(largest) {}
    // Both ways refer to the sheet.
    Splatter(const Splatter&) = delete;
    Splatter& operator=(const Splatter&) = delete;

    /// Begins with a slab.
    /// @param layout  of the whole sheet, or of a part of it (layoutRows)
    void begin(const PlannedSlab& slab, const SheetLayout& layout);
    /// Makes the sheet of the slab's next slice, and returns it. Deltas are added to what the slice
    /// before left; of a whole slab, each slice starts anew.
    /// @param firstRow,lastRow  rows of the sheet that are needed: [firstRow, lastRow). Others may
    /// hold an earlier slice, or part of this one
    const Sheet& splat(int slice, int firstRow, int lastRow);
    /// Ends a slab.
    void end();

    /// Bytes that a splatter takes.
    static double bytes(const SplatInput& input, const SheetLayout& layout);

  private:
    template <typename Use>
    decltype(auto) withWay(const Use& use) {
        return stamping_ ? use(*stamps_) : use(*tiles_);
    }

    const SplatInput& input_;
    SheetLayout largest_;
    Sheet sheet_;
    std::optional<StampSplatter> stamps_;  // each made when it is first needed
    std::optional<TileSplatter> tiles_;
    bool stamping_ = false;  // of the slab in hand
    bool whole_ = false;     // likewise
};

}  // namespace deltasplat
