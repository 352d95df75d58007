// SPDX-License-Identifier: Apache-2.0
// Facts and codes of floats, compiled once per SIMD level.
#include "volume/float_kernels.h"

#include <algorithm>
#include <limits>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/float_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Calls use(values, codes) per vector. The last is padded with the first value, codes dropped.
template <std::size_t kLanes, typename T, typename Use>
HWY_INLINE void forVectors(std::span<const T> values, Code* codes, const Use& use) {
    std::size_t n = 0;
    for (; n + kLanes <= values.size(); n += kLanes) use(&values[n], codes ? codes + n : nullptr);
    if (n == values.size()) return;
    T rest[kLanes];
    Code codesOfRest[kLanes];
    std::fill_n(std::copy(values.begin() + std::ptrdiff_t(n), values.end(), rest),
                kLanes - (values.size() - n), values[0]);
    use(rest, codesOfRest);
    if (codes) std::copy_n(codesOfRest, values.size() - n, codes + n);
}

FloatFacts factsOfKernel(std::span<const float> values) {
    const hn::CappedTag<float, 16> tag;
    const hn::RebindToSigned<decltype(tag)> bitsTag;
    constexpr std::size_t kLanes = hn::MaxLanes(decltype(tag)());
    const auto none = hn::Set(tag, std::numeric_limits<float>::max());
    auto min = hn::Set(tag, values[0]);
    auto max = min;
    auto least = none;
    auto most = hn::Zero(bitsTag);   // largest pattern of a magnitude
    auto wrong = hn::Zero(bitsTag);  // bits that no half has
    auto isHalf = hn::Eq(none, none);
    auto isWhole = isHalf;
    forVectors<kLanes>(values, nullptr, [&](const float* from, Code*) HWY_ATTR {
        const auto value = hn::LoadU(tag, from);
        const auto magnitude = hn::Abs(value);
        const auto pattern = hn::BitCast(bitsTag, magnitude);
        const auto isZero = hn::Eq(value, hn::Zero(tag));
        min = hn::Min(min, value);
        max = hn::Max(max, value);
        least = hn::Min(least, hn::IfThenElse(isZero, none, magnitude));
        most = hn::Max(most, pattern);
        // Halves have 10 mantissa bits; below 2^-14, multiples of 2^-24, the precision beside 0.5.
        wrong = hn::Or(wrong, hn::And(pattern, hn::Set(bitsTag, (1 << 13) - 1)));
        const auto half = hn::Set(tag, 0.5f);
        const auto kept = hn::Sub(hn::Add(magnitude, half), half);
        const auto isSmall = hn::Lt(magnitude, hn::Set(tag, 0x1p-14f));
        isHalf = hn::And(isHalf, hn::Or(hn::Not(isSmall), hn::Eq(kept, magnitude)));
        // From 2^23 on all floats are whole. -0 is no integer.
        const auto small = hn::IfThenElseZero(hn::Lt(magnitude, hn::Set(tag, 0x1p23f)), value);
        const auto whole = hn::ConvertTo(tag, hn::ConvertTo(bitsTag, small));
        const auto isNegativeZero = hn::And(
            isZero, hn::RebindMask(tag, hn::Lt(hn::BitCast(bitsTag, value), hn::Zero(bitsTag))));
        isWhole = hn::And(isWhole, hn::AndNot(isNegativeZero, hn::Eq(whole, small)));
    });
    HWY_ALIGN float lanes[3][kLanes];
    HWY_ALIGN std::int32_t patterns[2][kLanes];
    hn::Store(min, tag, lanes[0]);
    hn::Store(max, tag, lanes[1]);
    hn::Store(least, tag, lanes[2]);
    hn::Store(most, bitsTag, patterns[0]);
    hn::Store(wrong, bitsTag, patterns[1]);
    constexpr std::int32_t kInfinity = 0x7f800000;
    constexpr std::int32_t kLargestHalf = 0x477fe000;
    const std::int32_t largest = *std::max_element(patterns[0], patterns[0] + kLanes);
    const bool hasWrong =
        std::any_of(patterns[1], patterns[1] + kLanes, [](std::int32_t bits) { return bits != 0; });
    FloatFacts facts;
    facts.isFinite = largest < kInfinity;
    facts.isHalf = !hasWrong && largest <= kLargestHalf && hn::AllTrue(tag, isHalf);
    facts.isWhole = hn::AllTrue(tag, isWhole);
    // The sign of a zero extreme differs between levels. Adding 0 makes it positive.
    facts.min = *std::min_element(lanes[0], lanes[0] + kLanes) + 0.0f;
    facts.max = *std::max_element(lanes[1], lanes[1] + kLanes) + 0.0f;
    facts.least = *std::min_element(lanes[2], lanes[2] + kLanes);
    if (facts.min == 0 && facts.max == 0) facts.least = 0;
    return facts;
}

void codesOfHalvesKernel(std::span<const float> values, Code* codes) {
    const hn::CappedTag<float, 16> tag;
    const hn::RebindToSigned<decltype(tag)> bitsTag;
    const hn::Rebind<Code, decltype(tag)> codeTag;
    forVectors<hn::MaxLanes(decltype(tag)())>(
        values, codes, [&](const float* from, Code* to) HWY_ATTR {
            const auto value = hn::LoadU(tag, from);
            const auto magnitude = hn::Abs(value);
            // The exponent bias of floats is 112 larger. Below 2^-14 halves have equal steps.
            const auto normal = hn::Sub(hn::ShiftRight<13>(hn::BitCast(bitsTag, magnitude)),
                                        hn::Set(bitsTag, 112 << 10));
            const auto steps = hn::ConvertTo(bitsTag, hn::Mul(magnitude, hn::Set(tag, 0x1p24f)));
            const auto isSmall = hn::RebindMask(bitsTag, hn::Lt(magnitude, hn::Set(tag, 0x1p-14f)));
            const auto pattern = hn::IfThenElse(isSmall, steps, normal);
            const auto isNegative = hn::Lt(hn::BitCast(bitsTag, value), hn::Zero(bitsTag));
            const auto turn =
                hn::IfThenElse(isNegative, hn::Set(bitsTag, 0x7fff), hn::Set(bitsTag, 0x8000));
            hn::StoreU(hn::DemoteTo(codeTag, hn::Xor(pattern, turn)), codeTag, to);
        });
}

void codesOfWholeKernel(std::span<const float> values, float offset, Code* codes) {
    const hn::CappedTag<float, 16> tag;
    const hn::RebindToSigned<decltype(tag)> bitsTag;
    const hn::Rebind<Code, decltype(tag)> codeTag;
    const auto first = hn::Set(tag, offset);
    forVectors<hn::MaxLanes(decltype(tag)())>(
        values, codes, [&](const float* from, Code* to) HWY_ATTR {
            const auto steps = hn::ConvertTo(bitsTag, hn::Sub(hn::LoadU(tag, from), first));
            hn::StoreU(hn::DemoteTo(codeTag, steps), codeTag, to);
        });
}

bool codesOfHalfBitsKernel(std::span<const std::uint16_t> bits, Code* codes) {
    const hn::CappedTag<std::uint16_t, 32> tag;
    const hn::RebindToSigned<decltype(tag)> signedTag;
    const auto exponent = hn::Set(tag, std::uint16_t{0x7c00});
    const auto positive = hn::Set(tag, std::uint16_t{0x8000});
    auto isFinite = hn::Eq(exponent, exponent);
    forVectors<hn::MaxLanes(decltype(tag)())>(
        bits, codes, [&](const std::uint16_t* from, Code* to) HWY_ATTR {
            const auto pattern = hn::LoadU(tag, from);
            isFinite = hn::AndNot(hn::Eq(hn::And(pattern, exponent), exponent), isFinite);
            const auto sign = hn::BitCast(tag, hn::ShiftRight<15>(hn::BitCast(signedTag, pattern)));
            hn::StoreU(hn::Xor(pattern, hn::Or(sign, positive)), tag, to);
        });
    return hn::AllTrue(tag, isFinite);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(factsOfKernel);
HWY_EXPORT(codesOfHalvesKernel);
HWY_EXPORT(codesOfWholeKernel);
HWY_EXPORT(codesOfHalfBitsKernel);

FloatFacts factsOf(std::span<const float> values) {
    return HWY_DYNAMIC_DISPATCH(factsOfKernel)(values);
}

void codesOfHalves(std::span<const float> values, Code* codes) {
    HWY_DYNAMIC_DISPATCH(codesOfHalvesKernel)(values, codes);
}

void codesOfWhole(std::span<const float> values, float offset, Code* codes) {
    HWY_DYNAMIC_DISPATCH(codesOfWholeKernel)(values, offset, codes);
}

bool codesOfHalfBits(std::span<const std::uint16_t> bits, Code* codes) {
    return HWY_DYNAMIC_DISPATCH(codesOfHalfBitsKernel)(bits, codes);
}

}  // namespace deltasplat
#endif
