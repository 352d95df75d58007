// SPDX-License-Identifier: Apache-2.0
// The inner loop of describing leaves of codes, compiled once for each SIMD level.
#include "ingest/codes/code_kernels.h"

#include <algorithm>

#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ingest/codes/code_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

std::pair<Code, Code> rangeOfCodesKernel(std::span<const Code> codes) {
    const hn::ScalableTag<Code> tag;
    const std::size_t lanes = hn::Lanes(tag);
    Code lowest = codes.front();
    Code highest = codes.front();
    std::size_t i = 0;
    if (codes.size() >= lanes) {
        auto low = hn::LoadU(tag, codes.data());
        auto high = low;
        for (i = lanes; i + lanes <= codes.size(); i += lanes) {
            const auto next = hn::LoadU(tag, &codes[i]);
            low = hn::Min(low, next);
            high = hn::Max(high, next);
        }
        HWY_ALIGN Code lows[hn::MaxLanes(hn::ScalableTag<Code>())];
        HWY_ALIGN Code highs[hn::MaxLanes(hn::ScalableTag<Code>())];
        hn::Store(low, tag, lows);
        hn::Store(high, tag, highs);
        lowest = *std::min_element(lows, lows + lanes);
        highest = *std::max_element(highs, highs + lanes);
    }
    for (; i < codes.size(); ++i) {
        lowest = std::min(lowest, codes[i]);
        highest = std::max(highest, codes[i]);
    }
    return {lowest, highest};
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(rangeOfCodesKernel);

std::pair<Code, Code> rangeOfCodes(std::span<const Code> codes) {
    return HWY_DYNAMIC_DISPATCH(rangeOfCodesKernel)(codes);
}

}  // namespace deltasplat
#endif
