// SPDX-License-Identifier: Apache-2.0
// Based on: Edwin Catmull and Raphael Rom, "A Class of Local Interpolating Splines", 1974.
#include "image/filter_table.h"

#include <algorithm>
#include <cmath>

namespace deltasplat {
namespace {

// Fine enough that rounding a position moves a value by less than 1/2000 of what it changes over
// the filter's width.
constexpr double kStepsPerWidth = 1024;

double catmullRom(double x) {
    x = std::abs(x);
    if (x < 1) return 1 + x * x * (1.5 * x - 2.5);
    if (x < 2) return 2 - x * (4 - x * (2.5 - 0.5 * x));
    return 0;
}

// A raster that is smaller than a pixel by more than this adds nothing to it that could be seen.
constexpr double kMaxStretch = 16384;

}  // namespace

FilterTable::FilterTable(double wantedStretch) {
    const double stretch = std::min(wantedStretch, kMaxStretch);
    taps_ = 2 * int(std::ceil(2 * stretch));
    paddedTaps_ = (taps_ + 3) / 4 * 4;
    steps_ = std::max(4, int(kStepsPerWidth / stretch));
    weights_.resize(std::size_t(steps_ + 1) * paddedTaps_ * 4);
    std::vector<double> exact(taps_);
    for (int step = 0; step <= steps_; ++step) {
        double sum = 0;
        for (int tap = 0; tap < taps_; ++tap) {
            exact[tap] = catmullRom((firstTap(0) + tap - double(step) / steps_) / stretch);
            sum += exact[tap];
        }
        float* weights = &weights_[std::size_t(step) * 4 * paddedTaps_];
        for (int tap = 0; tap < taps_; ++tap) {
            std::fill_n(weights + 4 * tap, 4, float(exact[tap] / sum));
        }
    }
}

}  // namespace deltasplat
