// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "splat/pixel_splatter.h"
#include "splat/stamp_splatter.h"
#include "splat/tile_splatter.h"

namespace deltasplat {

/// Turns slabs into sheets of one digit of colours, in the way that suits the footprint and how
/// much changes. Holds what that takes, to be used for one slab after the other; not thread-safe.
class DigitSplatter {
  public:
    /// @param largest  of the layouts to come
    /// @param hasLow   whether the low digit is added to this, the high one: along with it
    ///                 (addsLow), or as a sheet where it is summed
    DigitSplatter(const SplatInput& input, const SheetLayout& largest, DigitPlace digit,
                  bool hasLow)
        : input_(input),
          largest_(largest),
          digit_(digit),
          hasLow_(hasLow),
          sheet_(largest, input.memory) {
        const DigitVoxels* voxels = input.digitVoxels;
        if (voxels && voxels->of(digit) && !PixelSplatter::fits(input.footprint))
            isFew_ = voxels->fewerThan(TileSplatter::leastStamps(input.footprint), digit);
    }
    // All ways refer to the sheet.
    DigitSplatter(const DigitSplatter&) = delete;
    DigitSplatter& operator=(const DigitSplatter&) = delete;

    /// Whether the low digit goes along with the high one, and has no sheet of its own.
    static bool addsLow(const Footprint& footprint) {
        return PixelSplatter::fits(footprint) || TileSplatter::addsLow(footprint);
    }

    /// Begins with a slab.
    /// @param layout  of the whole sheet, or of a part of it (layoutPart)
    void begin(const PlannedSlab& slab, const SheetLayout& layout);
    /// Makes the sheet of the slab's next slice, and returns it. Deltas are added to what the slice
    /// before left; of a whole slab, each slice starts anew.
    /// @param needed  others may hold an earlier slice, or part of this one
    /// @param low     the sheet of the low digit, or null
    const Sheet& splat(int slice, const NeededPixels& needed, const Sheet* low = nullptr);
    /// Whether the slab in hand is stamped: then the low digit is not added.
    bool isStamping() const { return stamping_; }
    /// Ends a slab.
    void end();

    /// Bytes that it takes.
    static double bytes(const SplatInput& input, const SheetLayout& layout, bool hasLow);

  private:
    bool isFew(const PlannedSlab& slab) const;

    const SplatInput& input_;
    SheetLayout largest_;
    DigitPlace digit_;
    bool hasLow_;
    std::optional<bool> isFew_;  // of several digits: whether few voxels of a block have this one
    Sheet sheet_;
    std::optional<PixelSplatter> pixels_;  // each made when it is first needed
    std::optional<StampSplatter> stamps_;
    std::optional<TileSplatter> tiles_;
    bool stamping_ = false;  // of the slab in hand
    bool whole_ = false;     // likewise
};

}  // namespace deltasplat
