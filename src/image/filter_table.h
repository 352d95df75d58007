// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace deltasplat {

/// Weights of a Catmull-Rom filter along one axis, for every position between two lattice points in
/// small steps.
class FilterTable {
  public:
    /// @param wantedStretch  lattice points a picture pixel, at least 1: the filter is that much
    /// wider, up to 16384
    ///                       times
    explicit FilterTable(double wantedStretch);

    int taps() const { return taps_; }
    /// Taps rounded up to a multiple of four; the weights of the added ones are zero.
    int paddedTaps() const { return paddedTaps_; }
    /// The first lattice point under the filter at a position whose floor is `whole`.
    int firstTap(int whole) const { return whole - (taps_ / 2 - 1); }
    /// Returns paddedTaps() weights, each repeated for four channels, for a position `fraction`
    /// (0..1) behind a lattice point.
    const float* weights(double fraction) const {
        return &weights_[std::size_t(fraction * steps_ + 0.5) * 4 * paddedTaps_];
    }

  private:
    int taps_ = 0;
    int paddedTaps_ = 0;
    int steps_ = 0;
    std::vector<float> weights_;  // [steps_ + 1][paddedTaps_][4]
};

}  // namespace deltasplat
