// SPDX-License-Identifier: Apache-2.0
// Based on: T. J. Dekker, "A Floating-Point Technique for Extending the Available Precision", 1971
// (sums and products as pairs); W. J. Cody and W. Waite, "Software Manual for the Elementary
// Functions", 1980 (a constant taken away in parts); Taylor's series of exp, sin and cos and that
// of log((1 + f) / (1 - f)) = 2 atanh(f).
#include "base/portable_math.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace deltasplat::portable {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The number high + low, with |low| at most half an ulp of high.
struct Pair {
    double high, low;
};

// As std::ldexp(), without a call where 2^exponent is a number like others.
double timesPowerOfTwo(double x, int exponent) {
    if (exponent < -1022 || exponent > 1023) return std::ldexp(x, exponent);
    return x * std::bit_cast<double>(std::uint64_t(exponent + 1023) << 52);
}

// As std::floor(), likewise, of less than 2^62 but -0.
double wholeBelow(double x) {
    const auto cut = double(std::int64_t(x));
    return cut > x ? cut - 1 : cut;
}

// a + b exactly, for |a| >= |b| or a = 0.
Pair sumOfOrdered(double a, double b) {
    const double sum = a + b;
    return {sum, b - (sum - a)};
}

Pair sum(double a, double b) {
    const double sum = a + b;
    const double fromB = sum - a;
    return {sum, (a - (sum - fromB)) + (b - fromB)};
}

// a * b exactly, if neither overflows when multiplied by 2^27.
Pair product(double a, double b) {
    const auto upperHalf = [](double x) {
        const double scaled = x * (0x1p27 + 1);
        return scaled - (scaled - x);
    };
    const double aHigh = upperHalf(a), aLow = a - aHigh;
    const double bHigh = upperHalf(b), bLow = b - bHigh;
    const double high = a * b;
    return {high, ((aHigh * bHigh - high) + aHigh * bLow + aLow * bHigh) + aLow * bLow};
}

Pair product(const Pair& a, const Pair& b) {
    const Pair main = product(a.high, b.high);
    return sumOfOrdered(main.high, main.low + (a.high * b.low + a.low * b.high));
}

Pair quotient(const Pair& a, const Pair& b) {
    const double first = a.high / b.high;
    const Pair back = product(first, b.high);
    const double left = (((a.high - back.high) - back.low) + a.low) - first * b.low;
    return sumOfOrdered(first, left / b.high);
}

// Horner's rule; the first coefficient is that of the highest power.
template <int N>
double polynomial(double x, const double (&coefficients)[N]) {
    double value = 0;
    for (const double coefficient : coefficients) value = value * x + coefficient;
    return value;
}

// ln 2 in two parts: a product of the first with an exponent is exact.
constexpr double kLn2High = 0x1.62e42feep-1;
constexpr double kLn2Low = 0x1.a39ef35793c76p-33;

// The logarithm of high + low, positive and finite, to about 65 bits.
Pair logarithm(const Pair& x) {
    int exponent = 0;
    double part = std::frexp(x.high, &exponent);
    if (part < 0.5 * std::numbers::sqrt2) {
        part *= 2;
        --exponent;
    }
    const double partLow = std::ldexp(x.low, -exponent);

    // With f = (part - 1) / (part + 1), |f| < 0.172, and s = f^2, the logarithm of part is
    // 2 f (1 + s (1/3 + s (1/5 + ...))).
    const Pair above = sum(part, 1);
    const Pair f = quotient(sum(part - 1, partLow), {above.high, above.low + partLow});
    const Pair s = product(f, f);
    constexpr double kSeries[] = {1 / 27.0, 1 / 25.0, 1 / 23.0, 1 / 21.0, 1 / 19.0, 1 / 17.0,
                                  1 / 15.0, 1 / 13.0, 1 / 11.0, 1 / 9.0,  1 / 7.0,  1 / 5.0};
    const Pair third = sumOfOrdered(1 / 3.0, s.high * polynomial(s.high, kSeries));
    constexpr double kThirdLow = 0x1.5555555555555p-56;  // 1/3 less its nearest double
    const Pair rest = product(f, product(s, {third.high, third.low + kThirdLow}));
    const Pair half = sumOfOrdered(f.high, rest.high);
    const Pair ofPart = {2 * half.high, 2 * (half.low + (f.low + rest.low))};

    const Pair whole = sum(exponent * kLn2High, ofPart.high);
    return sumOfOrdered(whole.high, whole.low + (ofPart.low + exponent * kLn2Low));
}

// e^x as 2^exponent (1 + rest + tail), |rest| < 0.35 and tail much smaller.
struct Exponential {
    int exponent;
    double rest, tail;
};

Exponential exponential(const Pair& x) {
    const double exponent = wholeBelow(x.high * std::numbers::log2e + 0.5);
    const Pair r = sum(x.high - exponent * kLn2High, x.low - exponent * kLn2Low);
    // 1/14! ... 1/2!
    constexpr double kSeries[] = {
        1 / 87178291200.0, 1 / 6227020800.0, 1 / 479001600.0, 1 / 39916800.0, 1 / 3628800.0,
        1 / 362880.0,      1 / 40320.0,      1 / 5040.0,      1 / 720.0,      1 / 120.0,
        1 / 24.0,          1 / 6.0,          1 / 2.0};
    const double curve = r.high * r.high * polynomial(r.high, kSeries);
    return {int(exponent), r.high, curve + r.low * (1 + r.high)};
}

// Beyond these, e^x is 0 or infinite, and e^x - 1 is -1.
constexpr double kLeastExponent = -746;
constexpr double kMostExponent = 710;

double exp(const Pair& x) {
    if (x.high < kLeastExponent) return 0;
    if (x.high > kMostExponent) return kInfinity;
    const Exponential e = exponential(x);
    const Pair main = sumOfOrdered(1, e.rest);
    return timesPowerOfTwo(main.high + (main.low + e.tail), e.exponent);
}

// x = quarter * pi / 2 + rest + tail, |rest| < 0.79.
struct Turn {
    int quarter;  // 0..3
    double rest, tail;
};

Turn turnOf(double x) {
    // A product of the first two parts with up to 20 bits is exact.
    constexpr double kHalfPi[] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};
    const double quarters = std::floor(x * (2 / std::numbers::pi) + 0.5);
    const Pair rest = sum(x - quarters * kHalfPi[0], -quarters * kHalfPi[1]);
    const Pair sharp = sum(rest.high, rest.low - quarters * kHalfPi[2]);
    return {int(quarters) & 3, sharp.high, sharp.low};
}

double sineOfRest(const Turn& turn) {
    // -1/3!, 1/5!, ...
    constexpr double kSeries[] = {
        1 / 355687428096000.0, -1 / 1307674368000.0, 1 / 6227020800.0, -1 / 39916800.0,
        1 / 362880.0,          -1 / 5040.0,          1 / 120.0,        -1 / 6.0};
    const double s = turn.rest * turn.rest;
    return turn.rest + (turn.rest * (s * polynomial(s, kSeries)) + turn.tail * (1 - 0.5 * s));
}

double cosineOfRest(const Turn& turn) {
    // 1/4!, -1/6!, ...
    constexpr double kSeries[] = {
        1 / 20922789888000.0, -1 / 87178291200.0, 1 / 479001600.0, -1 / 3628800.0,
        1 / 40320.0,          -1 / 720.0,         1 / 24.0};
    const Pair s = product(turn.rest, turn.rest);
    const Pair main = sumOfOrdered(1, -0.5 * s.high);
    const double curve = s.high * (s.high * polynomial(s.high, kSeries));
    return main.high + (main.low + (curve - 0.5 * s.low - turn.rest * turn.tail));
}

// The sine of an angle that is `more` quarter turns larger.
double sineTurned(double x, int more) {
    if (!(std::abs(x) <= 1e6)) return kNan;
    const Turn turn = turnOf(x);
    const int quarter = (turn.quarter + more) & 3;
    const double value = quarter & 1 ? cosineOfRest(turn) : sineOfRest(turn);
    return quarter & 2 ? -value : value;
}

// Of 0..1. Half an angle has the tangent t / (1 + sqrt(1 + t^2)); a quarter is small enough for the
// series.
double arcTangent(double t) {
    for (int half = 0; half < 2; ++half) t = t / (1 + std::sqrt(1 + t * t));
    // 1/21, -1/19, ... -1/3
    constexpr double kSeries[] = {1 / 21.0,  -1 / 19.0, 1 / 17.0, -1 / 15.0, 1 / 13.0,
                                  -1 / 11.0, 1 / 9.0,   -1 / 7.0, 1 / 5.0,   -1 / 3.0};
    const double s = t * t;
    return 4 * (t + t * (s * polynomial(s, kSeries)));
}

}  // namespace

double exp(double x) {
    return std::isnan(x) ? x : exp(Pair{x, 0});
}

double expm1(double x) {
    if (std::isnan(x) || x == 0) return x;
    if (x < -40) return -1;
    if (x > kMostExponent) return kInfinity;
    const Exponential e = exponential({x, 0});
    // 2^k (1 + r) - 1 = 2^k (1 - 2^-k + r)
    const Pair main = sum(1 - timesPowerOfTwo(1, -e.exponent), e.rest);
    return timesPowerOfTwo(main.high + (main.low + e.tail), e.exponent);
}

double log(double x) {
    if (!(x > 0)) return x == 0 ? -kInfinity : kNan;
    return std::isinf(x) ? x : logarithm({x, 0}).high;
}

double log1p(double x) {
    if (!(x > -1)) return x == -1 ? -kInfinity : kNan;
    if (std::isinf(x) || std::abs(x) < 0x1p-60) return x;
    return logarithm(sum(1, x)).high;
}

double pow(double x, double y) {
    if (y == 0 || x == 1) return 1;
    if (!(x >= 0) || std::isnan(y)) return kNan;
    if (x == 0) return y > 0 ? 0 : kInfinity;
    if (std::isinf(x)) return y > 0 ? kInfinity : 0;
    const Pair ofBase = logarithm({x, 0});
    const double rough = y * ofBase.high;
    if (rough < kLeastExponent) return 0;
    if (rough > kMostExponent) return kInfinity;
    const Pair main = product(y, ofBase.high);
    return exp(sumOfOrdered(main.high, main.low + y * ofBase.low));
}

double sin(double x) {
    return x == 0 ? x : sineTurned(x, 0);
}

double cos(double x) {
    return sineTurned(x, 1);
}

double atan2(double y, double x) {
    if (std::isnan(x) || std::isnan(y)) return kNan;
    const double a = std::abs(x);
    const double b = std::abs(y);
    const double larger = std::max(a, b);
    const double smaller = std::min(a, b);
    const double share = smaller == larger ? (larger > 0 ? 1 : 0) : smaller / larger;
    double angle = arcTangent(share);
    if (b > a) angle = std::numbers::pi / 2 - angle;
    if (std::signbit(x)) angle = std::numbers::pi - angle;
    return std::copysign(angle, y);
}

}  // namespace deltasplat::portable
