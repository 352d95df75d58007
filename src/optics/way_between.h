// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// How far x is on the way from a to b, 0..1; halves, so that no difference overflows.
inline double wayBetween(double a, double b, double x) {
    return (0.5 * x - 0.5 * a) / (0.5 * b - 0.5 * a);
}

}  // namespace deltasplat
