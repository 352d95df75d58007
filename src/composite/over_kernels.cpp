// SPDX-License-Identifier: Apache-2.0
// The compositor's inner loops, compiled once per SIMD level.
#include "composite/over_kernels.h"

#include <bit>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "composite/over_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FullTag = hn::ScalableTag<float>;

// One pixel, for the rest of a span.
template <int kChannels>
using RestTag = hn::FixedTag<float, kChannels == 4 ? 4 : 1>;

// Pixels read at a time, so that they stay in the first-level cache.
constexpr std::size_t kStretch = 128;
// A span this short ends before its stores can be loaded again.
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

// Puts one vector of values behind a layer.
template <int kChannels, class Tag, class V>
HWY_INLINE void over(Tag tag, V color, float* layer) {
    auto front = hn::LoadU(tag, layer);
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128
    // Keeps GCC from loading it twice, as an operand.
    asm("" : "+v"(front.raw));
#endif
    const auto clear = hn::Sub(hn::Set(tag, 1.0f), opacityOf<kChannels>(front));
    hn::StoreU(hn::Add(front, hn::Mul(clear, color)), tag, layer);
}

// Calls use(tag, i) for whole vectors of `count` values, then for the rest.
template <int kChannels, typename Use>
HWY_INLINE void forVectors(std::size_t count, const Use& use) {
    const FullTag full;
    const RestTag<kChannels> rest;
    std::size_t i = 0;
    for (; i + hn::Lanes(full) <= count; i += hn::Lanes(full)) use(full, i);
    for (; i < count; i += hn::Lanes(rest)) use(rest, i);
}

// A span of one plane.
struct PlaneRun {
    PlaneRun(const OverSpan& span, const OverSheets& sheets, const OverWeights& weights, int plane)
        : row(sheets.pixels[std::size_t(plane)] + span.place),
          nextRow(row + sheets.pitch),
          thisWeight(weights.thisRow[std::size_t(plane)]),
          nextWeight(weights.nextRow[std::size_t(plane)]) {}

    const std::int32_t* row;
    const std::int32_t* nextRow;
    const glm::vec4& thisWeight;
    const glm::vec4& nextWeight;
};

// Interpolates along columns.
template <int kChannels, class Tag>
HWY_INLINE hn::Vec<Tag> readColumn(Tag tag, const PlaneRun& run, std::size_t i) {
    const auto here =
        hn::Mul(readSheet(tag, run.row + i), loadScale<kChannels>(tag, run.thisWeight));
    const auto next =
        hn::Mul(readSheet(tag, run.nextRow + i), loadScale<kChannels>(tag, run.nextWeight));
    return hn::Add(here, next);
}

// For sheet pixels that coincide with the layer's.
template <int kChannels>
HWY_INLINE void overStraight(const PlaneRun& run, float* layer, std::size_t pixels) {
    forVectors<kChannels>(kChannels * pixels, [&](auto tag, std::size_t i) {
        const auto color =
            hn::Mul(readSheet(tag, run.row + i), loadScale<kChannels>(tag, run.thisWeight));
        over<kChannels>(tag, color, layer + i);
    });
}

// Interpolates finished columns along rows.
template <int kChannels>
HWY_INLINE void overColumns(const float* columns, const OverWeights& weights, float* layer,
                            std::size_t pixels) {
    forVectors<kChannels>(kChannels * pixels, [&](auto tag, std::size_t i) {
        const auto here = hn::Mul(hn::LoadU(tag, columns + i), hn::Set(tag, weights.thisColumn));
        const auto next =
            hn::Mul(hn::LoadU(tag, columns + i + kChannels), hn::Set(tag, weights.nextColumn));
        over<kChannels>(tag, hn::Add(here, next), layer + i);
    });
}

// Interpolates along columns first, then along rows.
template <int kChannels>
HWY_INLINE void overStretch(const PlaneRun& run, const OverWeights& weights, float* layer,
                            std::size_t pixels) {
    HWY_ALIGN float columns[(kStretch + 1) * kChannels];
    forVectors<kChannels>(kChannels * (pixels + 1), [&](auto tag, std::size_t i) {
        hn::StoreU(readColumn<kChannels>(tag, run, i), tag, columns + i);
    });
    overColumns<kChannels>(columns, weights, layer, pixels);
}

// Gives the same arithmetic, reading each column twice and storing nothing.
template <int kChannels>
HWY_INLINE void overShort(const PlaneRun& run, const OverWeights& weights, float* layer,
                          std::size_t pixels) {
    forVectors<kChannels>(kChannels * pixels, [&](auto tag, std::size_t i) {
        const auto here =
            hn::Mul(readColumn<kChannels>(tag, run, i), hn::Set(tag, weights.thisColumn));
        const auto next = hn::Mul(readColumn<kChannels>(tag, run, i + kChannels),
                                  hn::Set(tag, weights.nextColumn));
        over<kChannels>(tag, hn::Add(here, next), layer + i);
    });
}

// Sums the columns of several planes first.
template <int kChannels>
void overPlanes(const OverSpan& span, const OverSheets& sheets, const OverWeights& weights) {
    HWY_ALIGN float columns[(kStretch + 1) * kChannels];
    const std::size_t behind = weights.straight ? 0 : 1;
    for (unsigned rest = span.planes; rest != 0; rest &= rest - 1) {
        const PlaneRun run(span, sheets, weights, std::countr_zero(rest));
        const bool first = rest == span.planes;
        forVectors<kChannels>(kChannels * (span.pixels + behind), [&](auto tag, std::size_t i) {
            // A straight reading gives the next row no weight.
            const auto column = weights.straight
                                    ? hn::Mul(readSheet(tag, run.row + i),
                                              loadScale<kChannels>(tag, run.thisWeight))
                                    : readColumn<kChannels>(tag, run, i);
            const auto sum = first ? column : hn::Add(hn::LoadU(tag, columns + i), column);
            hn::StoreU(sum, tag, columns + i);
        });
    }
    if (!weights.straight) return overColumns<kChannels>(columns, weights, span.layer, span.pixels);
    forVectors<kChannels>(kChannels * span.pixels, [&](auto tag, std::size_t i) {
        over<kChannels>(tag, hn::LoadU(tag, columns + i), span.layer + i);
    });
}

template <int kChannels>
HWY_INLINE void overPlane(const OverSpan& span, PlaneRun run, const OverWeights& weights) {
    if (weights.straight) return overStraight<kChannels>(run, span.layer, span.pixels);
    if (span.pixels <= kShort) return overShort<kChannels>(run, weights, span.layer, span.pixels);
    float* layer = span.layer;
    std::size_t pixels;
    for (std::size_t rest = span.pixels; rest > 0; rest -= pixels) {
        pixels = rest < kStretch ? rest : kStretch;
        overStretch<kChannels>(run, weights, layer, pixels);
        run.row += kChannels * pixels;
        run.nextRow += kChannels * pixels;
        layer += kChannels * pixels;
    }
}

template <int kChannels>
void overSpansOf(const std::vector<OverSpan>& spans, const OverSheets& sheets,
                 const OverWeights& weights) {
    for (OverSpan span : spans) {
        if (span.planes == 1) {
            overPlane<kChannels>(span, {span, sheets, weights, 0}, weights);
            continue;
        }
        for (std::uint32_t rest = span.pixels; rest > 0; rest -= span.pixels) {
            span.pixels = rest < kStretch ? rest : kStretch;
            overPlanes<kChannels>(span, sheets, weights);
            span.place += kChannels * span.pixels;
            span.layer += kChannels * span.pixels;
        }
    }
}

void overSpansKernel(const std::vector<OverSpan>& spans, const OverSheets& sheets,
                     const OverWeights& weights) {
    return weights.channels == 4 ? overSpansOf<4>(spans, sheets, weights)
                                 : overSpansOf<1>(spans, sheets, weights);
}

template <int kChannels>
void mergeBehindOf(float* front, const float* layer, std::size_t pixels) {
    forVectors<kChannels>(kChannels * pixels, [&](auto tag, std::size_t i) {
        over<kChannels>(tag, hn::LoadU(tag, layer + i), front + i);
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

void overSpans(const std::vector<OverSpan>& spans, const OverSheets& sheets,
               const OverWeights& weights) {
    HWY_DYNAMIC_DISPATCH(overSpansKernel)(spans, sheets, weights);
}

void mergeBehind(float* front, const float* layer, std::size_t pixels, int channels) {
    HWY_DYNAMIC_DISPATCH(mergeBehindKernel)(front, layer, pixels, channels);
}

}  // namespace deltasplat
#endif
