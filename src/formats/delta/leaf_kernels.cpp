// SPDX-License-Identifier: Apache-2.0
// Inner loops of adding up deltas, compiled once per SIMD level.
#include "formats/delta/leaf_kernels.h"

#include <algorithm>
#include <bit>

#include "base/simd_targets.h"
#include "formats/delta/exact_slots.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "formats/delta/leaf_kernels.cpp"
#include "hwy/foreach_target.h"
// Highway requires this order: after foreach_target.h.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void addDeltasKernel(std::uint64_t word, const std::int32_t* HWY_RESTRICT deltas,
                     std::uint32_t* HWY_RESTRICT slots) {
    if (word == ~std::uint64_t{0}) {
        const hn::CappedTag<std::uint32_t, 16> tag;
        const auto one = hn::Set(tag, 1u);
        for (std::size_t n = 0; n < 64; n += hn::Lanes(tag)) {
            const auto number = hn::LoadU(tag, reinterpret_cast<const std::uint32_t*>(deltas + n));
            const auto sign = hn::Sub(hn::Zero(tag), hn::And(number, one));
            const auto delta = hn::Xor(hn::ShiftRight<1>(number), sign);
            hn::StoreU(hn::Add(hn::LoadU(tag, slots + n), delta), tag, slots + n);
        }
        return;
    }
    for (; word != 0; word &= word - 1)
        slots[std::countr_zero(word)] += std::uint32_t(fromZigzag(*deltas++));
}

// Shortens slots if all values up to the highest are allowed.
HWY_INLINE bool shortenValues(const std::uint32_t* HWY_RESTRICT slots, const SlotRules& rules,
                              ShortSlot* HWY_RESTRICT out) {
    const hn::CappedTag<std::uint32_t, 16> tag;
    const hn::RebindToSigned<decltype(tag)> signedTag;
    const hn::Rebind<ShortSlot, decltype(tag)> shortTag;
    const auto highest = hn::Set(tag, rules.highest);
    const auto rest = hn::Set(tag, std::uint32_t{rules.rest});
    auto most = hn::Zero(tag);
    for (std::size_t n = 0; n < 64; n += hn::Lanes(tag)) {
        const auto slot = hn::LoadU(tag, slots + n);
        most = hn::Max(most, slot);
        const auto shown = hn::IfThenElse(hn::Eq(slot, hn::Zero(tag)), rest, slot);
        hn::StoreU(hn::DemoteTo(shortTag, hn::BitCast(signedTag, shown)), shortTag, out + n);
    }
    return hn::AllTrue(tag, hn::Eq(hn::Max(most, highest), highest));
}

bool shortenSlotsKernel(const std::uint32_t* HWY_RESTRICT slots, const SlotRules& rules,
                        ShortSlot* HWY_RESTRICT out) {
    if (rules.lowest == 1 && rules.inactiveCount == 0) return shortenValues(slots, rules, out);
    const hn::CappedTag<std::uint32_t, 16> tag;
    const hn::RebindToSigned<decltype(tag)> signedTag;
    const hn::Rebind<ShortSlot, decltype(tag)> shortTag;
    const auto lowest = hn::Set(tag, rules.lowest);
    const auto span = hn::Set(tag, rules.highest - rules.lowest);
    const auto firstInactive = hn::Set(tag, rules.firstInactive);
    const auto endInactive = hn::Set(tag, rules.firstInactive + rules.inactiveCount);
    const auto rest = hn::Set(tag, std::uint32_t{rules.rest});
    auto areSound = hn::Eq(lowest, lowest);
    for (std::size_t n = 0; n < 64; n += hn::Lanes(tag)) {
        const auto slot = hn::LoadU(tag, slots + n);
        const auto place = hn::Sub(slot, lowest);
        const auto isValue = hn::Eq(hn::Min(place, span), place);
        const auto isBehind = hn::Eq(hn::Max(slot, firstInactive), slot);
        const auto isNumber = hn::And(isBehind, hn::Not(hn::Eq(hn::Max(slot, endInactive), slot)));
        const auto isEmpty = hn::Eq(slot, hn::Zero(tag));
        areSound = hn::And(areSound, hn::Or(hn::Or(isValue, isEmpty), isNumber));
        const auto shown =
            hn::Or(hn::IfThenElseZero(isValue, slot), hn::IfThenElseZero(isEmpty, rest));
        hn::StoreU(hn::DemoteTo(shortTag, hn::BitCast(signedTag, shown)), shortTag, out + n);
    }
    return hn::AllTrue(tag, areSound);
}

SlotRange rangeOfKernel(const ShortSlot* HWY_RESTRICT slots) {
    const hn::CappedTag<ShortSlot, 32> tag;
    const auto one = hn::Set(tag, ShortSlot{1});
    // Subtracting one makes empty slots the highest number.
    auto lowest = hn::Set(tag, ShortSlot{0xffff});
    auto least = lowest;
    auto highest = hn::Zero(tag);
    for (std::size_t n = 0; n < 512; n += hn::Lanes(tag)) {
        const auto slot = hn::LoadU(tag, slots + n);
        lowest = hn::Min(lowest, hn::Sub(slot, one));
        least = hn::Min(least, slot);
        highest = hn::Max(highest, slot);
    }
    HWY_ALIGN ShortSlot lanes[3][32];
    hn::Store(lowest, tag, lanes[0]);
    hn::Store(least, tag, lanes[1]);
    hn::Store(highest, tag, lanes[2]);
    const std::size_t count = hn::Lanes(tag);
    const ShortSlot low = *std::min_element(lanes[0], lanes[0] + count);
    return {ShortSlot(low + 1), *std::max_element(lanes[2], lanes[2] + count),
            *std::min_element(lanes[1], lanes[1] + count) == 0};
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(addDeltasKernel);
HWY_EXPORT(shortenSlotsKernel);
HWY_EXPORT(rangeOfKernel);

void addDeltas(std::uint64_t word, const std::int32_t* deltas, std::uint32_t* slots) {
    HWY_DYNAMIC_DISPATCH(addDeltasKernel)(word, deltas, slots);
}

bool shortenSlots(const std::uint32_t* slots, const SlotRules& rules, ShortSlot* out) {
    return HWY_DYNAMIC_DISPATCH(shortenSlotsKernel)(slots, rules, out);
}

SlotRange rangeOf(const ShortSlot* slots) {
    return HWY_DYNAMIC_DISPATCH(rangeOfKernel)(slots);
}

}  // namespace deltasplat
#endif
