// SPDX-License-Identifier: Apache-2.0
// Compiled once per SIMD level. Colours are rounded one by one, so all levels give the same bits.
#include "optics/digit_kernels.h"

#include "base/simd_targets.h"
#include "optics/color_digits.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optics/digit_kernels.cpp"
#include "hwy/foreach_target.h"
// Highway requires this after foreach_target.h.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using UnitTag = hn::CappedTag<float, 8>;
using Units = hn::Vec<UnitTag>;
using IntTag = hn::Rebind<std::int32_t, UnitTag>;
using Integers = hn::Vec<IntTag>;

HWY_INLINE Units number(double x) {
    return hn::Set(UnitTag(), float(x));
}

// A channel in whole units and the relative error of rounding to them.
struct Rounded {
    Units whole, error;
};

// Half-way rounds up, like std::round.
HWY_INLINE Rounded rounded(Units units) {
    const auto whole = hn::Floor(hn::Add(units, number(0.5)));
    return {whole, hn::Div(hn::Sub(whole, units), hn::Max(units, number(kLeastUnits)))};
}

HWY_INLINE void store(const Integers (&channels)[4], ClassTable::Color* colors) {
    const hn::Rebind<std::int16_t, UnitTag> narrow;
    hn::StoreInterleaved4(hn::DemoteTo(narrow, channels[0]), hn::DemoteTo(narrow, channels[1]),
                          hn::DemoteTo(narrow, channels[2]), hn::DemoteTo(narrow, channels[3]),
                          narrow, colors->data());
}

template <class Mask>
HWY_INLINE std::uint64_t bitsOf(Mask mask) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(UnitTag(), mask, bits);
    return bits[0];
}

MoreDigits writeDigitsKernel(const WordUnits& units, ClassTable::Color* high,
                             ClassTable::Color* low) {
    const UnitTag tag;
    const IntTag whole;
    MoreDigits more;
    for (std::size_t n = 0; n < 64; n += hn::Lanes(tag)) {
        const auto load = [&](std::size_t c) {
            return hn::Min(hn::LoadU(tag, &units[c][n]), number(ClassTable::kMax));
        };
        const Units colors[4] = {load(0), load(1), load(2), load(3)};
        const auto most = number(kColorShare);
        const Rounded alpha = rounded(colors[3]);
        auto isEnough = hn::Le(hn::Abs(alpha.error), most);
        Integers digits[4];
        digits[3] = hn::ConvertTo(whole, alpha.whole);
        for (std::size_t c = 0; c < 3; ++c) {
            const Rounded one = rounded(colors[c]);
            const auto isUnseen = hn::Lt(colors[c], number(kLeastUnits));
            const auto isSameShare = hn::Le(hn::Abs(hn::Sub(one.error, alpha.error)), most);
            isEnough = hn::And(isEnough, hn::Le(hn::Abs(one.error), most));
            isEnough = hn::And(isEnough, hn::Or(isUnseen, isSameShare));
            digits[c] = hn::ConvertTo(whole, one.whole);
        }
        const std::uint64_t others = bitsOf(hn::Not(isEnough));
        if (others != 0) {
            constexpr double kLow = double(1 << ClassTable::kDigitBits);
            Integers lowDigits[4];
            auto isLess = hn::Lt(colors[3], number(kLeastOfPlane));
            for (std::size_t c = 0; c < 4; ++c) {
                // The fraction does not count: small channels go to the second plane (more.planes).
                const auto fine = hn::ConvertTo(
                    whole, hn::Floor(hn::Add(hn::Mul(colors[c], number(kLow)), number(0.5))));
                const auto isMore = hn::RebindMask(whole, hn::Not(isEnough));
                digits[c] =
                    hn::IfThenElse(isMore, hn::ShiftRight<ClassTable::kDigitBits>(fine), digits[c]);
                lowDigits[c] = hn::And(fine, hn::Set(whole, ClassTable::kMax));
                isLess = hn::Or(isLess, hn::Lt(colors[c], number(kLeastOfPlane)));
            }
            store(lowDigits, low + n);
            more.low |= others << n;
            more.planes |= (others & bitsOf(isLess)) << n;
        }
        store(digits, high + n);
    }
    return more;
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(writeDigitsKernel);

MoreDigits writeDigits(const WordUnits& units, ClassTable::Color* high, ClassTable::Color* low) {
    return HWY_DYNAMIC_DISPATCH(writeDigitsKernel)(units, high, low);
}

}  // namespace deltasplat
#endif
