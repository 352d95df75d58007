// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace deltasplat {

/// What is between lattice points. None lets a value leave the range of its neighbours.
enum class WarpFilter {
    kSharp,     ///< Catmull-Rom, clamped to the nearest lattice points: for pictures
    kMitchell,  ///< clamped to all lattice points that it reads
    kGauss,
    kBox  ///< what a square as wide as the stretch covers of the lattice points' own squares
};

/// Weights of a filter along one axis, for every position between two lattice points in small
/// steps: what reading them takes.
class FilterView {
  public:
    int taps() const { return taps_; }
    /// Taps rounded up to a multiple of four; the weights of the added ones are zero.
    int paddedTaps() const { return paddedTaps_; }
    /// Taps in the middle, an even number, whose range a sum is clamped to if weights may be
    /// negative: as many as never make it jump where taps change.
    int innerTaps() const { return innerTaps_; }
    /// The first of them.
    int firstInnerTap() const { return (taps_ - innerTaps_) / 2; }
    /// Whether weights may be negative, so that sums have to be clamped to the inner taps' range.
    bool overshoots() const { return overshoots_; }
    /// The first lattice point under the filter at a position whose floor is `whole`.
    int firstTap(int whole) const { return whole - (taps_ / 2 - 1); }
    /// Returns paddedTaps() weights for a position that lies `fraction` / 2^32 behind a lattice
    /// point.
    const float* weights(std::uint32_t fraction) const {
        return &weights_[stepOf(fraction) * paddedTaps_];
    }
    /// Most that the filter can enlarge a value: the largest sum of its weights' magnitudes.
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
    int shift_ = 0;                   // there are 2^(32 - shift_) steps
    const float* weights_ = nullptr;  // [steps + 1][paddedTaps_]
};

/// A filter and its weights.
class FilterTable : public FilterView {
  public:
    /// @param wantedStretch  lattice points a picture pixel, at least 1: the filter is that much
    /// wider, up to 16384 times
    /// @param halvings  how often the lattice's points were halved (halved_raster.h): weights are
    /// of what is left of them, those that come closest to the filter
    FilterTable(WarpFilter filter, double wantedStretch, int halvings = 0);
    FilterTable(const FilterTable&) = delete;
    FilterTable& operator=(const FilterTable&) = delete;

  private:
    std::vector<float> ownWeights_;
};

}  // namespace deltasplat
