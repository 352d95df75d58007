// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace deltasplat {

/// Returns 0 up to `low`, 1 from `high` on, and between a curve that is level at both ends.
inline double smoothStep(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Returns the larger number, or a little more (`width` / 4 at most) where they differ by less than
/// `width`: surfaces that are where this is 0 flow together without a crease.
inline double smoothMax(double a, double b, double width) {
    const double near = std::max(width - std::abs(a - b), 0.0) / width;
    return std::max(a, b) + near * near * width / 4;
}

}  // namespace deltasplat
