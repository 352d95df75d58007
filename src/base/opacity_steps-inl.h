// SPDX-License-Identifier: Apache-2.0
// Opacity of any number of steps, for the kernels of each SIMD level: the same bits at all of them.
#if defined(DELTASPLAT_OPACITY_STEPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DELTASPLAT_OPACITY_STEPS_INL_H_
#undef DELTASPLAT_OPACITY_STEPS_INL_H_
#else
#define DELTASPLAT_OPACITY_STEPS_INL_H_
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FullTag = hn::ScalableTag<float>;
using Vector = hn::Vec<FullTag>;

HWY_INLINE Vector constant(double x) {
    return hn::Set(FullTag(), float(x));
}

HWY_INLINE Vector mulAdd(Vector a, Vector b, Vector c) {
    return hn::Add(hn::Mul(a, b), c);
}

// Returns the logarithm of 1 - a to base 2, for 0 <= a <= 1; -127 for what is 1.
HWY_INLINE Vector logOfClear(Vector a) {
    const FullTag tag;
    const hn::RebindToSigned<FullTag> whole;
    const auto clear = hn::Sub(constant(1), a);
    // A power of 2 times a number from sqrt(1/2) to sqrt(2).
    const auto bits = hn::BitCast(whole, clear);
    const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(whole, 0x3F3504F3)));
    const auto mantissa = hn::BitCast(tag, hn::Sub(bits, hn::ShiftLeft<23>(exponent)));
    // Of what is hardly opaque 1 - a has lost digits.
    const auto isPlain = hn::RebindMask(tag, hn::Eq(exponent, hn::Zero(whole)));
    const auto beyond = hn::IfThenElse(isPlain, hn::Neg(a), hn::Sub(mantissa, constant(1)));
    const auto s = hn::Div(beyond, hn::Add(constant(2), beyond));
    const auto z = hn::Mul(s, s);
    // 2 / ln 2 (s + s^3 / 3 + s^5 / 5 + s^7 / 7), in pairs: what waits for nothing takes no time.
    const auto low = mulAdd(z, constant(0.961796694), constant(2.88539008));
    const auto high = mulAdd(z, constant(0.412198583), constant(0.577078016));
    const auto sum = mulAdd(hn::Mul(z, z), high, low);
    return mulAdd(sum, s, hn::ConvertTo(tag, exponent));
}

// Returns 1 - 2^x for x <= 0.
HWY_INLINE Vector opacityOfLog(Vector x) {
    const FullTag tag;
    const hn::RebindToSigned<FullTag> whole;
    x = hn::Max(x, constant(-126));
    // Added, it leaves no digits behind the point: the whole number is in the lowest bits.
    const auto rounder = constant(12582912);
    const auto shifted = hn::Add(x, rounder);
    const auto rest = hn::Sub(x, hn::Sub(shifted, rounder));
    const auto scale = hn::BitCast(
        tag, hn::Add(hn::ShiftLeft<23>(hn::BitCast(whole, shifted)), hn::Set(whole, 0x3F800000)));
    // 2^rest - 1, of |rest| <= 1/2: its series, likewise
    const auto square = hn::Mul(rest, rest);
    const auto low = mulAdd(rest, constant(0.240226507), constant(0.693147181));
    const auto middle = mulAdd(rest, constant(9.61812911e-3), constant(5.55041087e-2));
    const auto high = mulAdd(rest, constant(1.54035304e-4), constant(1.33335581e-3));
    const auto sum =
        hn::Mul(rest, mulAdd(hn::Mul(square, square), high, mulAdd(square, middle, low)));
    // -(scale * sum + (scale - 1))
    return hn::Sub(hn::Sub(constant(1), scale), hn::Mul(scale, sum));
}

// Opacity of so many steps through what has opacity `a` in one.
HWY_INLINE Vector opacityOfSteps(Vector a, Vector steps) {
    const auto bounded = hn::Min(hn::Max(a, constant(0)), constant(1));
    return opacityOfLog(hn::Mul(steps, logOfClear(bounded)));
}

// Returns by how much opacity `a` grows in so many steps: (1 - (1 - a)^steps) / a, right to 2e-6.
HWY_INLINE Vector growthOfSteps(Vector a, Vector steps) {
    const FullTag tag;
    // The binomial series, to its fifth term: right where opacity is low and steps are 0.84 to 2.
    auto sum = mulAdd(a, mulAdd(steps, constant(-0.2), constant(0.8)), constant(1));
    sum = mulAdd(hn::Mul(a, mulAdd(steps, constant(-0.25), constant(0.75))), sum, constant(1));
    sum =
        mulAdd(hn::Mul(a, mulAdd(steps, constant(-1.0 / 3), constant(2.0 / 3))), sum, constant(1));
    const auto beyond = hn::Mul(hn::Mul(steps, a), mulAdd(steps, constant(-0.5), constant(0.5)));
    const auto series = mulAdd(beyond, sum, steps);
    const auto isLow = hn::And(hn::Le(a, constant(0.1875)),
                               hn::And(hn::Ge(steps, constant(0.84)), hn::Le(steps, constant(2))));
    if (hn::AllTrue(tag, isLow)) return series;
    // What is next to clear grows with its steps.
    const auto isClear = hn::Lt(a, constant(1e-30));
    const auto grown = hn::Div(opacityOfSteps(a, steps), a);
    return hn::IfThenElse(isLow, series, hn::IfThenElse(isClear, steps, grown));
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
