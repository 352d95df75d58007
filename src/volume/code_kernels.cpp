// SPDX-License-Identifier: Apache-2.0
// Inner loops that describe blocks of codes, compiled once per SIMD level.
#include "volume/code_kernels.h"

#include <algorithm>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/code_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Combines all lanes of a vector, first by vectors of eight lanes.
template <typename T, class Combine, class CombineTwo>
HWY_INLINE T fold(hn::Vec<hn::ScalableTag<T>> vector, const Combine& combine,
                  const CombineTwo& combineTwo) {
    HWY_ALIGN T lanes[std::max<std::size_t>(8, hn::MaxLanes(hn::ScalableTag<T>()))];
    hn::Store(vector, hn::ScalableTag<T>(), lanes);
    const hn::CappedTag<T, 8> few;
    auto sum = hn::Load(few, lanes);
    for (std::size_t i = hn::Lanes(few); i < hn::Lanes(hn::ScalableTag<T>()); i += hn::Lanes(few))
        sum = combine(sum, hn::Load(few, lanes + i));
    hn::Store(sum, few, lanes);
    T all = lanes[0];
    for (std::size_t i = 1; i < hn::Lanes(few); ++i) all = combineTwo(all, lanes[i]);
    return all;
}

template <typename T>
HWY_INLINE std::pair<Code, Code> rangeOf(std::span<const T> codes) {
    const hn::ScalableTag<T> tag;
    const std::size_t lanes = hn::Lanes(tag);
    T lowest = codes.front();
    T highest = codes.front();
    std::size_t i = 0;
    if (codes.size() >= lanes) {
        auto low = hn::LoadU(tag, codes.data());
        auto high = low;
        for (i = lanes; i + lanes <= codes.size(); i += lanes) {
            const auto next = hn::LoadU(tag, &codes[i]);
            low = hn::Min(low, next);
            high = hn::Max(high, next);
        }
        lowest = fold<T>(
            low, [](auto a, auto b) { return hn::Min(a, b); },
            [](T a, T b) { return std::min(a, b); });
        highest = fold<T>(
            high, [](auto a, auto b) { return hn::Max(a, b); },
            [](T a, T b) { return std::max(a, b); });
    }
    for (; i < codes.size(); ++i) {
        lowest = std::min(lowest, codes[i]);
        highest = std::max(highest, codes[i]);
    }
    return {lowest, highest};
}

std::pair<Code, Code> rangeOfCodesKernel(std::span<const Code> codes) {
    return rangeOf(codes);
}

std::pair<Code, Code> rangeOfBytesKernel(std::span<const std::uint8_t> codes) {
    return rangeOf(codes);
}

// Each number costs a comparison per vector: faster than counting while numbers <= lanes.
template <typename T>
HWY_INLINE std::size_t countFew(std::span<const T> codes, Code lowest, Code highest,
                                std::uint32_t* counts) {
    const hn::ScalableTag<T> tag;
    const std::size_t lanes = hn::Lanes(tag);
    const std::size_t numbers = std::size_t(highest - lowest) + 1;
    if (numbers > std::min(lanes, kMostFewCodes) || codes.size() % lanes != 0) return 0;
    for (std::size_t n = 0; n < numbers; ++n) {
        const auto number = hn::Set(tag, T(lowest + n));
        std::size_t count = 0;
        for (std::size_t i = 0; i < codes.size(); i += lanes)
            count += hn::CountTrue(tag, hn::Eq(hn::LoadU(tag, &codes[i]), number));
        counts[n] = std::uint32_t(count);
    }
    return numbers;
}

std::size_t countFewCodesKernel(std::span<const Code> codes, Code lowest, Code highest,
                                std::uint32_t* counts) {
    return countFew(codes, lowest, highest, counts);
}

std::size_t countFewBytesKernel(std::span<const std::uint8_t> codes, Code lowest, Code highest,
                                std::uint32_t* counts) {
    return countFew(codes, lowest, highest, counts);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(rangeOfCodesKernel);
HWY_EXPORT(rangeOfBytesKernel);
HWY_EXPORT(countFewCodesKernel);
HWY_EXPORT(countFewBytesKernel);

std::pair<Code, Code> rangeOfCodes(std::span<const Code> codes) {
    return HWY_DYNAMIC_DISPATCH(rangeOfCodesKernel)(codes);
}

std::pair<Code, Code> rangeOfCodes(std::span<const std::uint8_t> codes) {
    return HWY_DYNAMIC_DISPATCH(rangeOfBytesKernel)(codes);
}

std::size_t countFewCodes(std::span<const Code> codes, Code lowest, Code highest,
                          FewCounts& counts) {
    return HWY_DYNAMIC_DISPATCH(countFewCodesKernel)(codes, lowest, highest, counts.data());
}

std::size_t countFewCodes(std::span<const std::uint8_t> codes, Code lowest, Code highest,
                          FewCounts& counts) {
    return HWY_DYNAMIC_DISPATCH(countFewBytesKernel)(codes, lowest, highest, counts.data());
}

}  // namespace deltasplat
#endif
