// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "splat/slice_blocks.h"
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

/// Turns slabs into sheets of one plane of colours: of the high digit, and of the low one, where
/// there is one, rounded to the same units. To be used for one slab after the other; not
/// thread-safe.
class PlaneSplatter {
  public:
    /// @param largest  of the layouts to come
    PlaneSplatter(const SplatInput& input, const SheetLayout& largest, int plane);

    /// As those of DigitSplatter.
    void begin(const PlannedSlab& slab, const SheetLayout& layout);
    const Sheet& splat(int slice, const NeededPixels& needed);
    void end();

    static double bytes(const SplatInput& input, const SheetLayout& layout, int plane);

  private:
    // Of the slab in hand: tiles add the low digit themselves.
    bool sumsDigits() const { return low_ && high_.isStamping(); }

    const SplatInput& input_;
    SheetLayout largest_;
    std::optional<DigitSplatter> low_;  // where it is not summed along with the high one
    DigitSplatter high_;
    std::optional<Sheet> sum_;  // of both, made when stamps first make the high one
};

/// Turns slabs into sheets of all planes of colours.
class Splatter {
  public:
    /// @param largest  of the layouts to come
    Splatter(const SplatInput& input, const SheetLayout& largest);

    /// As those of DigitSplatter; there is a sheet for each plane, valid until the next call.
    void begin(const PlannedSlab& slab, const SheetLayout& layout);
    std::span<const Sheet* const> splat(int slice, const NeededPixels& needed);
    void end();

    /// Bytes that a splatter takes.
    static double bytes(const SplatInput& input, const SheetLayout& layout);

    // Planes refer to the input.
    Splatter(const Splatter&) = delete;
    Splatter& operator=(const Splatter&) = delete;

  private:
    std::optional<LitSlice> lit_;
    SplatInput input_;
    std::vector<std::unique_ptr<PlaneSplatter>> planes_;
    std::vector<const Sheet*> sheets_;
};

}  // namespace deltasplat
