// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

/// Functions that give the same bits on every processor. Those of the C library may differ by an
/// ulp from one machine to the next (glibc picks variants with and without FMA), and must not enter
/// pixels. These are made of additions, multiplications, divisions and exact functions alone, in an
/// order that is fixed, and are compiled without contraction. They are within 1 ulp of the true
/// value, atan2 within 4 (tests/unit/portable_math_test.cpp). Deterministic and thread-safe;
/// nothing is thrown.
namespace deltasplat::portable {

double exp(double x);
/// Returns exp(x) - 1.
double expm1(double x);
/// Returns the natural logarithm; NaN below 0, -infinity at 0.
double log(double x);
/// Returns log(1 + x).
double log1p(double x);
/// Returns x^y for x >= 0; NaN below 0.
double pow(double x, double y);
/// Of radians, |x| <= 10^6; NaN beyond.
double sin(double x);
double cos(double x);
/// Returns the angle of (x, y), -pi..pi, within 4 ulps; NaN if either is.
double atan2(double y, double x);

/// Returns the length of (x, y), without overflow on the way.
inline double hypot(double x, double y) {
    const double a = std::abs(x);
    const double b = std::abs(y);
    const double larger = a > b ? a : b;
    if (!(larger > 0) || std::isinf(larger)) return a + b;
    const double share = (a > b ? b : a) / larger;
    return larger * std::sqrt(1 + share * share);
}

}  // namespace deltasplat::portable
