// SPDX-License-Identifier: Apache-2.0
// Reads blocks of codes as values, compiled once per SIMD level.
#include "rays/block_kernels.h"

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rays/block_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using EightTag = hn::CappedTag<float, 8>;
using CodeTag = hn::FixedTag<Code, 8>;

// Transposes 8x8 codes; steps are between rows.
HWY_INLINE void transposeCodes(const Code* in, std::size_t inStep, Code* out, std::size_t outStep) {
    const CodeTag tag;
    const hn::RepartitionToWide<CodeTag> pairs;
    const hn::RepartitionToWide<decltype(pairs)> fours;
    const auto load = [&](int row) { return hn::LoadU(tag, in + row * inStep); };
    // Each step doubles the runs of codes of one column.
    const auto four = [&](int row, auto& low, auto& high) {
        const auto a = load(row), b = load(row + 1), c = load(row + 2), d = load(row + 3);
        const auto abLow = hn::BitCast(pairs, hn::InterleaveLower(tag, a, b));
        const auto abHigh = hn::BitCast(pairs, hn::InterleaveUpper(tag, a, b));
        const auto cdLow = hn::BitCast(pairs, hn::InterleaveLower(tag, c, d));
        const auto cdHigh = hn::BitCast(pairs, hn::InterleaveUpper(tag, c, d));
        low[0] = hn::BitCast(fours, hn::InterleaveLower(pairs, abLow, cdLow));
        low[1] = hn::BitCast(fours, hn::InterleaveUpper(pairs, abLow, cdLow));
        high[0] = hn::BitCast(fours, hn::InterleaveLower(pairs, abHigh, cdHigh));
        high[1] = hn::BitCast(fours, hn::InterleaveUpper(pairs, abHigh, cdHigh));
    };
    hn::Vec<decltype(fours)> topLow[2], topHigh[2], bottomLow[2], bottomHigh[2];
    four(0, topLow, topHigh);
    four(4, bottomLow, bottomHigh);
    const auto store = [&](int row, auto top, auto bottom) {
        hn::StoreU(hn::BitCast(tag, hn::InterleaveLower(fours, top, bottom)), tag,
                   out + row * outStep);
        hn::StoreU(hn::BitCast(tag, hn::InterleaveUpper(fours, top, bottom)), tag,
                   out + (row + 1) * outStep);
    };
    for (int half = 0; half < 2; ++half) {
        store(2 * half, topLow[half], bottomLow[half]);
        store(4 + 2 * half, topHigh[half], bottomHigh[half]);
    }
}

HWY_INLINE const Code* inSliceOrder(const Code* codes, int sliceAxis, Code* ordered) {
    if (sliceAxis == 0) return codes;
    for (std::size_t i = 0; i < 8; ++i) {
        if (sliceAxis == 1) {
            transposeCodes(codes + 8 * i, 64, ordered + 64 * i, 8);
        } else {
            transposeCodes(codes + 64 * i, 8, ordered + 8 * i, 64);
        }
    }
    return ordered;
}

template <bool kDirect>
HWY_INLINE void storeValues(const Code* codes, const CodeValues& values, const ValuePlace& place) {
    const EightTag tag;
    const hn::Rebind<std::int32_t, EightTag> wide;
    const hn::Rebind<Code, EightTag> narrow;
    const auto offset = hn::Set(tag, values.offset);
    codes += 64 * place.firstSlice;
    for (auto slice = std::size_t(place.firstSlice); slice <= std::size_t(place.lastSlice);
         ++slice) {
        for (std::size_t u = 0; u < 8; ++u, codes += 8) {
            float* out = place.first + slice * place.sliceStep + u * place.rowStep;
            for (std::size_t v = 0; v < 8; v += hn::Lanes(tag)) {
                const auto code = hn::PromoteTo(wide, hn::LoadU(narrow, codes + v));
                if constexpr (kDirect) {
                    hn::StoreU(hn::Add(hn::ConvertTo(tag, code), offset), tag, out + v);
                } else {
                    hn::StoreU(hn::GatherIndex(tag, values.table, code), tag, out + v);
                }
            }
        }
    }
}

void readBlockValuesKernel(const Code* codes, int sliceAxis, const CodeValues& values,
                           const ValuePlace& place) {
    HWY_ALIGN Code ordered[512];
    const Code* const from = inSliceOrder(codes, sliceAxis, ordered);
    values.direct ? storeValues<true>(from, values, place)
                  : storeValues<false>(from, values, place);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(readBlockValuesKernel);

void readBlockValues(const Code* codes, int sliceAxis, const CodeValues& values,
                     const ValuePlace& place) {
    HWY_DYNAMIC_DISPATCH(readBlockValuesKernel)(codes, sliceAxis, values, place);
}

}  // namespace deltasplat
#endif
