// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "splat/digit_splatter.h"

namespace deltasplat {

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
