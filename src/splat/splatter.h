// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <variant>

#include "splat/stamp_splatter.h"
#include "splat/tile_splatter.h"

namespace deltasplat {

/// Turns slabs into sheets, in the way that suits the footprint. Holds what that takes, to be used
/// for one slab after the other; not thread-safe.
class Splatter {
  public:
    /// @param largest  of the layouts to come
    Splatter(const SplatInput& input, const SheetLayout& largest);

    /// Calls `eachSlice(slice, sheet)` for the slab's slices in increasing order, with the sheet
    /// complete. Deltas are added to what the slice before left; of a whole slab, each slice starts
    /// anew.
    /// @param layout  of the whole sheet, or of a part of it (layoutRows)
    void run(const Slab& slab, const SheetLayout& layout,
             const std::function<void(int slice, const Sheet& sheet)>& eachSlice);

    /// Bytes that a splatter takes.
    static double bytes(const SheetLayout& layout);

  private:
    std::variant<StampSplatter, TileSplatter> way_;
};

}  // namespace deltasplat
