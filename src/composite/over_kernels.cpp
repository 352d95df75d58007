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

// One pixel: what is left at a span's end.
template <int kChannels>
using RestTag = hn::FixedTag<float, kChannels == 4 ? 4 : 1>;

// Pixels that are read at a time, so that they stay in the first-level cache.
constexpr std::size_t kStretch = 128;
// A span of no more pixels is over before what it stores can be loaded again.
constexpr std::size_t kShort = 32;

template <class Tag>
auto readSheet(Tag tag, const std::int32_t* sheet) {
    return hn::ConvertTo(tag, hn::LoadU(hn::RebindToSigned<Tag>(), sheet));
}

template <int kChannels, class Tag>
auto loadScale(Tag tag, const glm::vec4& scale) {
    if constexpr (kChannels == 4) {
        return hn::LoadDup128(tag, &scale.x);
    } else {
        return hn::Set(tag, scale.w);
    }
}

template <int kChannels, class V>
HWY_INLINE V opacityOf(V color) {
    if constexpr (kChannels == 4) {
        return hn::Broadcast<3>(color);
    } else {
        return color;
    }
}

// Composites as many values as the tag has lanes for.
template <int kChannels, bool kFrontToBack, class Tag, class V>
HWY_INLINE void over(Tag tag, V color, float* layer) {
    const auto below = hn::LoadU(tag, layer);
    const auto front = kFrontToBack ? below : color;
    const auto back = kFrontToBack ? color : below;
    const auto clear = hn::Sub(hn::Set(tag, 1.0f), opacityOf<kChannels>(front));
    hn::StoreU(hn::Add(front, hn::Mul(clear, back)), tag, layer);
}

// Calls use(tag, i) for whole vectors of `count` values, then for what is left.
template <int kChannels, typename Use>
HWY_INLINE void forVectors(std::size_t count, const Use& use) {
    const FullTag full;
    const RestTag<kChannels> rest;
    std::size_t i = 0;
    for (; i + hn::Lanes(full) <= count; i += hn::Lanes(full)) use(full, i);
    for (; i < count; i += hn::Lanes(rest)) use(rest, i);
}

// Sheet pixels fall on the layer's.
template <int kChannels, bool kFrontToBack>
HWY_INLINE void overStraight(const OverSpan& span, const OverWeights& weights) {
    forVectors<kChannels>(kChannels * span.pixels, [&](auto tag, std::size_t i) {
        const auto color =
            hn::Mul(readSheet(tag, span.row + i), loadScale<kChannels>(tag, weights.thisRow));
        over<kChannels, kFrontToBack>(tag, color, span.layer + i);
    });
}

// Reads along the columns first, then along the rows.
template <int kChannels, bool kFrontToBack>
HWY_INLINE void overStretch(const OverSpan& span, const OverWeights& weights) {
    HWY_ALIGN float columns[(kStretch + 1) * kChannels];
    forVectors<kChannels>(kChannels * (span.pixels + 1), [&](auto tag, std::size_t i) {
        const auto here =
            hn::Mul(readSheet(tag, span.row + i), loadScale<kChannels>(tag, weights.thisRow));
        const auto next =
            hn::Mul(readSheet(tag, span.nextRow + i), loadScale<kChannels>(tag, weights.nextRow));
        hn::StoreU(hn::Add(here, next), tag, columns + i);
    });
    forVectors<kChannels>(kChannels * span.pixels, [&](auto tag, std::size_t i) {
        const auto here = hn::Mul(hn::LoadU(tag, columns + i), hn::Set(tag, weights.thisColumn));
        const auto next =
            hn::Mul(hn::LoadU(tag, columns + i + kChannels), hn::Set(tag, weights.nextColumn));
        over<kChannels, kFrontToBack>(tag, hn::Add(here, next), span.layer + i);
    });
}

// The same arithmetic, each column read twice and nothing stored on the way.
template <int kChannels, bool kFrontToBack>
HWY_INLINE void overShort(const OverSpan& span, const OverWeights& weights) {
    forVectors<kChannels>(kChannels * span.pixels, [&](auto tag, std::size_t i) {
        const auto thisRow = loadScale<kChannels>(tag, weights.thisRow);
        const auto nextRow = loadScale<kChannels>(tag, weights.nextRow);
        const auto column = [&](std::size_t place) HWY_ATTR {
            return hn::Add(hn::Mul(readSheet(tag, span.row + place), thisRow),
                           hn::Mul(readSheet(tag, span.nextRow + place), nextRow));
        };
        const auto here = hn::Mul(column(i), hn::Set(tag, weights.thisColumn));
        const auto next = hn::Mul(column(i + kChannels), hn::Set(tag, weights.nextColumn));
        over<kChannels, kFrontToBack>(tag, hn::Add(here, next), span.layer + i);
    });
}

template <int kChannels, bool kFrontToBack>
void overSpansOf(const std::vector<OverSpan>& spans, const OverWeights& weights) {
    const bool straight = weights.straight();
    for (OverSpan span : spans) {
        if (straight) {
            overStraight<kChannels, kFrontToBack>(span, weights);
            continue;
        }
        if (span.pixels <= kShort) {
            overShort<kChannels, kFrontToBack>(span, weights);
            continue;
        }
        for (std::size_t rest = span.pixels; rest > 0; rest -= span.pixels) {
            span.pixels = rest < kStretch ? rest : kStretch;
            overStretch<kChannels, kFrontToBack>(span, weights);
            span.row += kChannels * span.pixels;
            span.nextRow += kChannels * span.pixels;
            span.layer += kChannels * span.pixels;
        }
    }
}

void overSpansKernel(const std::vector<OverSpan>& spans, const OverWeights& weights) {
    if (weights.channels == 4) {
        return weights.frontToBack ? overSpansOf<4, true>(spans, weights)
                                   : overSpansOf<4, false>(spans, weights);
    }
    return weights.frontToBack ? overSpansOf<1, true>(spans, weights)
                               : overSpansOf<1, false>(spans, weights);
}

template <int kChannels>
void mergeBehindOf(float* front, const float* layer, std::size_t pixels) {
    forVectors<kChannels>(kChannels * pixels, [&](auto tag, std::size_t i) {
        over<kChannels, true>(tag, hn::LoadU(tag, layer + i), front + i);
    });
}

void mergeBehindKernel(float* front, const float* layer, std::size_t pixels, int channels) {
    return channels == 4 ? mergeBehindOf<4>(front, layer, pixels)
                         : mergeBehindOf<1>(front, layer, pixels);
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

void mergeBehind(float* front, const float* layer, std::size_t pixels, int channels) {
    HWY_DYNAMIC_DISPATCH(mergeBehindKernel)(front, layer, pixels, channels);
}

}  // namespace deltasplat
#endif
