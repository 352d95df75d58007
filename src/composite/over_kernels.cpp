// SPDX-License-Identifier: Apache-2.0
// The compositor's inner loops, compiled once for each SIMD level.
#include "composite/over_kernels.h"

#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "composite/over_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FullTag = hn::ScalableTag<float>;
using PixelTag = hn::FixedTag<float, 4>;

// Reads whole sheet pixels as floats.
template <class Tag>
auto readSheet(Tag tag, const std::int32_t* sheet) {
    return hn::ConvertTo(tag, hn::LoadU(hn::RebindToSigned<Tag>(), sheet));
}

// The bilinear weights and the scale, in every lane they are needed.
template <class Tag>
struct Weights {
    using V = hn::Vec<Tag>;
    Weights(Tag tag, const OverWeights& weights)
        : corner00(hn::Set(tag, weights.corner[0])),
          corner10(hn::Set(tag, weights.corner[1])),
          corner01(hn::Set(tag, weights.corner[2])),
          corner11(hn::Set(tag, weights.corner[3])),
          scale(hn::LoadDup128(tag, &weights.scale.x)) {}
    V corner00, corner10, corner01, corner11, scale;
};

// Composites as many pixels as the tag has lanes for. `kShifted` is false where the sheet's pixels
// fall on the layer's: the other three corners would only add zeros.
template <bool kFrontToBack, bool kShifted, class Tag>
HWY_INLINE void overPixels(Tag tag, const Weights<Tag>& w, const std::int32_t* row,
                           const std::int32_t* nextRow, float* layer) {
    auto color = hn::Mul(readSheet(tag, row), w.corner00);
    if constexpr (kShifted) {
        color = hn::Add(color, hn::Mul(readSheet(tag, row + 4), w.corner10));
        const auto next = hn::Add(hn::Mul(readSheet(tag, nextRow), w.corner01),
                                  hn::Mul(readSheet(tag, nextRow + 4), w.corner11));
        color = hn::Add(color, next);
    }
    color = hn::Mul(color, w.scale);
    const auto below = hn::LoadU(tag, layer);
    const auto front = kFrontToBack ? below : color;
    const auto back = kFrontToBack ? color : below;
    const auto clear = hn::Sub(hn::Set(tag, 1.0f), hn::Broadcast<3>(front));
    hn::StoreU(hn::Add(front, hn::Mul(clear, back)), tag, layer);
}

template <bool kFrontToBack, bool kShifted>
void overSpansOf(const std::vector<OverSpan>& spans, const OverWeights& weights) {
    const FullTag full;
    const PixelTag single;
    const std::size_t step = hn::Lanes(full) / 4;
    const Weights<FullTag> fullWeights(full, weights);
    const Weights<PixelTag> singleWeights(single, weights);
    for (const OverSpan& span : spans) {
        std::size_t x = 0;
        for (; x + step <= span.pixels; x += step) {
            overPixels<kFrontToBack, kShifted>(full, fullWeights, span.row + 4 * x,
                                               span.nextRow + 4 * x, span.layer + 4 * x);
        }
        for (; x < span.pixels; ++x) {
            overPixels<kFrontToBack, kShifted>(single, singleWeights, span.row + 4 * x,
                                               span.nextRow + 4 * x, span.layer + 4 * x);
        }
    }
}

void overSpansKernel(const std::vector<OverSpan>& spans, const OverWeights& weights) {
    const bool shifted = weights.corner[0] != 1;
    if (weights.frontToBack) {
        return shifted ? overSpansOf<true, true>(spans, weights)
                       : overSpansOf<true, false>(spans, weights);
    }
    return shifted ? overSpansOf<false, true>(spans, weights)
                   : overSpansOf<false, false>(spans, weights);
}

template <class Tag>
HWY_INLINE void mergePixels(Tag tag, float* front, const float* layer) {
    const auto f = hn::LoadU(tag, front);
    const auto clear = hn::Sub(hn::Set(tag, 1.0f), hn::Broadcast<3>(f));
    hn::StoreU(hn::Add(f, hn::Mul(clear, hn::LoadU(tag, layer))), tag, front);
}

void mergeBehindKernel(float* front, const float* layer, std::size_t pixels) {
    const FullTag full;
    const std::size_t step = hn::Lanes(full) / 4;
    std::size_t x = 0;
    for (; x + step <= pixels; x += step) mergePixels(full, front + 4 * x, layer + 4 * x);
    for (; x < pixels; ++x) mergePixels(PixelTag(), front + 4 * x, layer + 4 * x);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(overSpansKernel);
HWY_EXPORT(mergeBehindKernel);

void overSpans(const std::vector<OverSpan>& spans, const OverWeights& weights) {
    HWY_DYNAMIC_DISPATCH(overSpansKernel)(spans, weights);
}

void mergeBehind(float* front, const float* layer, std::size_t pixels) {
    HWY_DYNAMIC_DISPATCH(mergeBehindKernel)(front, layer, pixels);
}

}  // namespace deltasplat
#endif
