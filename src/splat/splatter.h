// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "splat/slice_blocks.h"
#include "splat/tile_splatter.h"

namespace deltasplat {

/// Turns slabs, one after the other, into sheets of one digit of colours, in the way that suits the
/// footprint and the amount of change. Not thread-safe.
class DigitSplatter {
  public:
    /// @param largest  of all layouts to come
    /// @param hasLow   whether the low digit is added to this high one (addsLow), or as a sheet
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
    // All splatters refer to the sheet.
    DigitSplatter(const DigitSplatter&) = delete;
    DigitSplatter& operator=(const DigitSplatter&) = delete;

    /// Whether the low digit goes along with the high one, without a sheet of its own.
    static bool addsLow(const Footprint& footprint) {
        return PixelSplatter::fits(footprint) || TileSplatter::addsLow(footprint);
    }

    /// Begins a slab.
    /// @param layout  of the whole sheet, or of a part (layoutPart)
    void begin(const PlannedSlab& slab, const SheetLayout& layout);
    /// Returns the next slice's sheet, with deltas added to the last; whole slabs start anew.
    /// @param needed  other pixels may hold earlier slices, or parts of this one
    /// @param low     sheet of the low digit, or null
    const Sheet& splat(int slice, const NeededPixels& needed, const Sheet* low = nullptr);
    /// Whether the current slab is stamped, which adds no low digit.
    bool isStamping() const { return stamping_; }
    void end();

    static double bytes(const SplatInput& input, const SheetLayout& layout, bool hasLow);

  private:
    bool isFew(const PlannedSlab& slab) const;

    const SplatInput& input_;
    SheetLayout largest_;
    DigitPlace digit_;
    bool hasLow_;
    std::optional<bool> isFew_;  // with several digits: whether few voxels per block have this one
    Sheet sheet_;
    std::optional<PixelSplatter> pixels_;  // each made when first needed
    std::optional<StampSplatter> stamps_;
    std::optional<TileSplatter> tiles_;
    bool stamping_ = false;  // in the current slab
    bool whole_ = false;     // likewise
};

/// Turns slabs, one after the other, into sheets of one plane of colours: the high digit, plus the
/// low one if any, rounded to the same units. Not thread-safe.
class PlaneSplatter {
  public:
    /// @param largest  of all layouts to come
    PlaneSplatter(const SplatInput& input, const SheetLayout& largest, int plane);

    /// As in DigitSplatter.
    void begin(const PlannedSlab& slab, const SheetLayout& layout);
    const Sheet& splat(int slice, const NeededPixels& needed);
    void end();

    static double bytes(const SplatInput& input, const SheetLayout& layout, int plane);

  private:
    // Tiles add the low digit themselves.
    bool sumsDigits() const { return low_ && high_.isStamping(); }

    const SplatInput& input_;
    SheetLayout largest_;
    std::optional<DigitSplatter> low_;  // where it is not summed along with the high one
    DigitSplatter high_;
    std::optional<Sheet> sum_;  // of both, made when stamps first make the high one
};

class Splatter {
  public:
    /// @param largest  of all layouts to come
    Splatter(const SplatInput& input, const SheetLayout& largest);

    /// As in DigitSplatter, with a sheet per plane, valid until the next call.
    void begin(const PlannedSlab& slab, const SheetLayout& layout);
    std::span<const Sheet* const> splat(int slice, const NeededPixels& needed);
    void end();

    static double bytes(const SplatInput& input, const SheetLayout& layout);

    Splatter(const Splatter&) = delete;
    Splatter& operator=(const Splatter&) = delete;

  private:
    std::optional<LitSlice> lit_;
    SplatInput input_;
    std::vector<std::unique_ptr<PlaneSplatter>> planes_;
    std::vector<const Sheet*> sheets_;
};

}  // namespace deltasplat
