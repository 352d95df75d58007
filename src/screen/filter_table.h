// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace deltasplat {

/// Interpolation between lattice points. No value leaves the range of its neighbours.
enum class WarpFilter {
    kSharp,     ///< Catmull-Rom, clamped to the nearest lattice points: for pictures
    kMitchell,  ///< clamped to all lattice points that are read
    kGauss,
    kBox  ///< overlap of a square, as wide as the stretch, with the lattice points' squares
};

/// Weights of a filter along one axis, for finely spaced positions between lattice points.
class FilterView {
  public:
    int taps() const { return taps_; }
    /// Taps rounded up to a multiple of four; added taps have weight 0.
    int paddedTaps() const { return paddedTaps_; }
    /// Taps in the middle, an even number, to whose range a sum is clamped if weights may be
    /// negative. Chosen so that the sum never jumps where taps change.
    int innerTaps() const { return innerTaps_; }
    int firstInnerTap() const { return (taps_ - innerTaps_) / 2; }
    /// Whether weights may be negative, so that sums must be clamped to the inner taps' range.
    bool overshoots() const { return overshoots_; }
    /// The first lattice point under the filter at a position with floor `whole`.
    int firstTap(int whole) const { return whole - (taps_ / 2 - 1); }
    /// Returns paddedTaps() weights for a position `fraction` / 2^32 behind a lattice point.
    const float* weights(std::uint32_t fraction) const {
        return &weights_[stepOf(fraction) * paddedTaps_];
    }
    /// Largest factor by which the filter can enlarge a value: its largest sum of |weights|.
    double gain() const { return gain_; }

  protected:
    std::size_t stepOf(std::uint32_t fraction) const {
        return std::size_t((fraction + (std::uint64_t{1} << (shift_ - 1))) >> shift_);
    }

    int taps_ = 0;
    int paddedTaps_ = 0;
    int innerTaps_ = 0;
    bool overshoots_ = false;
    double gain_ = 1;
    int shift_ = 0;                   // 2^(32 - shift_) steps
    const float* weights_ = nullptr;  // [steps + 1][paddedTaps_]
};

class FilterTable : public FilterView {
  public:
    /// @param wantedStretch  lattice points per pixel, >= 1: widens the filter, at most to 16384
    /// @param halvings  of the lattice (halved_raster.h), which the weights make up for
    FilterTable(WarpFilter filter, double wantedStretch, int halvings = 0);
    FilterTable(const FilterTable&) = delete;
    FilterTable& operator=(const FilterTable&) = delete;

  private:
    std::vector<float> ownWeights_;
};

}  // namespace deltasplat
