// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "delta/packed_deltas.h"
#include "deltasplat/optics/class_table.h"
#include "deltasplat/splat/footprint.h"
#include "splat/sheet.h"

namespace deltasplat {

/// Everything that splatting slabs needs and does not change.
struct SplatInput {
    const PackedDeltas& deltas;
    const ClassTable& classes;
    const Footprint& footprint;
    /// Stamp every voxel of the box, the empty ones too (method `traditional`); all slabs must be
    /// whole.
    bool stampEmptyVoxels;
};

/// Turns slabs into sheets. Holds what that takes, to be used for one slab after the other; not
/// thread-safe.
class Splatter {
  public:
    /// @param largest  of the layouts to come
    Splatter(const SplatInput& input, const SheetLayout& largest);
    ~Splatter();

    /// Calls `eachSlice(slice, sheet)` for the slab's slices in increasing order, with the sheet
    /// complete. Deltas are added to what the slice before left; of a whole slab, each slice starts
    /// anew.
    /// @param layout  of the whole sheet, or of a part of it (layoutRows)
    void run(const Slab& slab, const SheetLayout& layout,
             const std::function<void(int slice, const Sheet& sheet)>& eachSlice);

    /// Bytes that a splatter takes.
    static double bytes(const SheetLayout& layout);

    class Kernel;

  private:
    std::unique_ptr<Kernel> kernel_;
};

}  // namespace deltasplat
