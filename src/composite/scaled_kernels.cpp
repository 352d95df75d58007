// SPDX-License-Identifier: Apache-2.0
// The inner loops of perspective compositing, compiled once for each SIMD level.
#include "composite/scaled_kernels.h"

#include <algorithm>
#include <cmath>

#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "composite/scaled_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FullTag = hn::ScalableTag<float>;
using Vector = hn::Vec<FullTag>;
using PixelTag = hn::FixedTag<float, 4>;

// Columns and pixels are worked on in whole vectors, which may reach over the last.
constexpr std::size_t kSpare = hn::MaxLanes(FullTag()) < 16 ? 16 : hn::MaxLanes(FullTag());

HWY_INLINE Vector constant(double x) {
    return hn::Set(FullTag(), float(x));
}

HWY_INLINE Vector mulAdd(Vector a, Vector b, Vector c) {
    return hn::Add(hn::Mul(a, b), c);
}

// Returns log(1 - a) for 0 <= a <= 1; -88 for what is 1.
HWY_INLINE Vector logOfClear(Vector a) {
    const FullTag tag;
    const hn::RebindToSigned<FullTag> whole;
    const auto clear = hn::Sub(constant(1), a);
    // A power of 2 times a number from sqrt(1/2) to sqrt(2).
    const auto bits = hn::BitCast(whole, clear);
    const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(whole, 0x3F3504F3)));
    const auto mantissa = hn::BitCast(tag, hn::Sub(bits, hn::ShiftLeft<23>(exponent)));
    // Of what is hardly opaque 1 - a has lost digits.
    const auto isPlain = hn::Eq(exponent, hn::Zero(whole));
    const auto beyond =
        hn::IfThenElse(hn::RebindMask(tag, isPlain), hn::Neg(a), hn::Sub(mantissa, constant(1)));
    const auto s = hn::Div(beyond, hn::Add(constant(2), beyond));
    const auto z = hn::Mul(s, s);
    auto sum = mulAdd(z, constant(2.0 / 7), constant(2.0 / 5));
    sum = mulAdd(z, sum, constant(2.0 / 3));
    sum = mulAdd(z, sum, constant(2));
    return mulAdd(hn::ConvertTo(tag, exponent), constant(0.69314718055994531), hn::Mul(s, sum));
}

// Returns 1 - exp(x) for x <= 0.
HWY_INLINE Vector opacityOfLog(Vector x) {
    const FullTag tag;
    const hn::RebindToSigned<FullTag> whole;
    x = hn::Max(x, constant(-87));
    const auto power = hn::NearestInt(hn::Mul(x, constant(1.4426950408889634)));
    const auto rest = hn::Sub(x, hn::Mul(hn::ConvertTo(tag, power), constant(0.69314718055994531)));
    auto sum = mulAdd(rest, constant(1.0 / 720), constant(1.0 / 120));
    sum = mulAdd(rest, sum, constant(1.0 / 24));
    sum = mulAdd(rest, sum, constant(1.0 / 6));
    sum = mulAdd(rest, sum, constant(0.5));
    sum = mulAdd(rest, sum, constant(1));
    sum = hn::Mul(rest, sum);
    const auto scale = hn::BitCast(tag, hn::ShiftLeft<23>(hn::Add(power, hn::Set(whole, 127))));
    // -(scale * sum + (scale - 1))
    return hn::Sub(hn::Sub(constant(1), scale), hn::Mul(scale, sum));
}

// Opacity of so many steps through what has opacity `a` in one.
HWY_INLINE Vector opacityOfSteps(Vector a, Vector steps) {
    const auto bounded = hn::Min(hn::Max(a, constant(0)), constant(1));
    return opacityOfLog(hn::Mul(steps, logOfClear(bounded)));
}

template <int kChannels, class Tag>
HWY_INLINE auto loadScale(Tag tag, const glm::vec4& scale) {
    if constexpr (kChannels == 4) {
        return hn::LoadDup128(tag, &scale.x);
    } else {
        return hn::Set(tag, scale.w);
    }
}

// Weighs the rows of every column; kRows is 0 where it is not known.
template <int kChannels, int kRows>
HWY_INLINE void sumRows(const ScaledSlice& slice, const ScaledRun& run, float* columns) {
    // No more than a sheet's rows have spare pixels for.
    const hn::CappedTag<float, kChannels == 4 ? 16 : 8> tag;
    const hn::RebindToSigned<decltype(tag)> whole;
    const std::size_t count = std::size_t(kChannels * run.columns(slice.columnTaps));
    const auto firstWeight = hn::Set(tag, run.rowWeights[0]);
    const auto secondWeight = hn::Set(tag, run.rowWeights[kRows == 2 ? 1 : 0]);
    for (std::size_t p = 0; p < slice.scales.size(); ++p) {
        const auto scale = loadScale<kChannels>(tag, slice.scales[p]);
        const std::int32_t* sheet = slice.sheets[p] + run.place;
        for (std::size_t i = 0; i < count; i += hn::Lanes(tag)) {
            const auto row = [&](int n) {
                return hn::ConvertTo(tag,
                                     hn::LoadU(whole, sheet + i + slice.pitch * std::size_t(n)));
            };
            auto sum = hn::Mul(row(0), firstWeight);
            if constexpr (kRows == 2) {
                sum = hn::Add(sum, hn::Mul(row(1), secondWeight));
            } else {
                for (int n = 1; n < slice.rowTaps; ++n)
                    sum = hn::Add(sum, hn::Mul(row(n), hn::Set(tag, run.rowWeights[n])));
            }
            sum = hn::Mul(sum, scale);
            if (p > 0) sum = hn::Add(hn::LoadU(tag, columns + i), sum);
            hn::StoreU(sum, tag, columns + i);
        }
    }
}

// Weighs the columns of every pixel; kTaps is 0 where it is not known.
template <int kChannels, int kTaps>
HWY_INLINE void sumColumns(const ScaledRun& run, int wantedTaps, const float* columns,
                           float* colors) {
    const int taps = kTaps ? kTaps : wantedTaps;
    const std::int32_t* first = run.first;
    const float* weights = run.columnWeights;
    for (int x = 0; x < run.pixels; ++x, weights += taps) {
        const float* column = columns + kChannels * (first[x] - first[0]);
        if constexpr (kChannels == 4) {
            const PixelTag tag;
            auto sum = hn::Mul(hn::LoadU(tag, column), hn::Set(tag, weights[0]));
            for (int i = 1; i < taps; ++i)
                sum =
                    hn::Add(sum, hn::Mul(hn::LoadU(tag, column + 4 * i), hn::Set(tag, weights[i])));
            hn::StoreU(sum, tag, colors + 4 * x);
        } else {
            float sum = column[0] * weights[0];
            for (int i = 1; i < taps; ++i) sum += column[i] * weights[i];
            colors[x] = sum;
        }
    }
}

// By how much light and opacity of each pixel grow with its steps.
HWY_INLINE void findGrowth(const float* colors, const float* steps, std::size_t pixels,
                           float* growth) {
    const FullTag tag;
    for (std::size_t i = 0; i < pixels; i += hn::Lanes(tag)) {
        Vector r, g, b, opacity;
        hn::LoadInterleaved4(tag, colors + 4 * i, r, g, b, opacity);
        const auto times = hn::LoadU(tag, steps + i);
        const auto longer = opacityOfSteps(opacity, times);
        // What is next to clear grows with its steps.
        const auto isClear = hn::Lt(opacity, constant(1e-30));
        hn::StoreU(hn::IfThenElse(isClear, times, hn::Div(longer, opacity)), tag, growth + i);
    }
}

// As many values as the tag has lanes.
template <bool kFrontToBack, class Tag, class V>
HWY_INLINE void overColors(Tag tag, V color, float* layer) {
    const auto below = hn::LoadU(tag, layer);
    const auto front = kFrontToBack ? below : color;
    const auto back = kFrontToBack ? color : below;
    const auto clear = hn::Sub(hn::Set(tag, 1.0f), hn::Broadcast<3>(front));
    hn::StoreU(hn::Add(front, hn::Mul(clear, back)), tag, layer);
}

template <bool kFrontToBack>
HWY_INLINE void overGrown(const float* colors, const float* growth, std::size_t pixels,
                          float* layer) {
    const FullTag tag;
    // Every growth four times, once for each channel.
    HWY_ALIGN std::int32_t four[hn::MaxLanes(FullTag())];
    for (std::size_t i = 0; i < hn::Lanes(tag); ++i) four[i] = std::int32_t(i / 4);
    const auto indices = hn::SetTableIndices(tag, four);
    const std::size_t perVector = hn::Lanes(tag) / 4;
    std::size_t i = 0;
    for (; i + perVector <= pixels; i += perVector) {
        const auto times = hn::TableLookupLanes(hn::LoadU(tag, growth + i), indices);
        overColors<kFrontToBack>(tag, hn::Mul(hn::LoadU(tag, colors + 4 * i), times),
                                 layer + 4 * i);
    }
    const PixelTag one;
    for (; i < pixels; ++i) {
        const auto color = hn::Mul(hn::LoadU(one, colors + 4 * i), hn::Set(one, growth[i]));
        overColors<kFrontToBack>(one, color, layer + 4 * i);
    }
}

template <bool kFrontToBack>
HWY_INLINE void overOpacities(const float* opacities, const float* steps, std::size_t pixels,
                              float* layer) {
    const FullTag tag;
    HWY_ALIGN float rest[hn::MaxLanes(FullTag())] = {};
    for (std::size_t i = 0; i < pixels; i += hn::Lanes(tag)) {
        auto color = hn::LoadU(tag, opacities + i);
        if (steps) {
            HWY_ALIGN float times[hn::MaxLanes(FullTag())] = {};
            std::copy_n(steps + i, std::min(hn::Lanes(tag), pixels - i), times);
            color = opacityOfSteps(color, hn::Load(tag, times));
        }
        const std::size_t count = std::min(hn::Lanes(tag), pixels - i);
        const bool isWhole = count == hn::Lanes(tag);
        if (!isWhole) std::copy_n(layer + i, count, rest);
        const auto below = hn::LoadU(tag, isWhole ? layer + i : rest);
        const auto front = kFrontToBack ? below : color;
        const auto back = kFrontToBack ? color : below;
        const auto sum = mulAdd(hn::Sub(constant(1), front), back, front);
        hn::StoreU(sum, tag, isWhole ? layer + i : rest);
        if (!isWhole) std::copy_n(rest, count, layer + i);
    }
}

template <int kChannels>
HWY_INLINE void readRun(const ScaledSlice& slice, const ScaledRun& run, float* colors) {
    HWY_ALIGN float columns[kChannels * kMostScaledColumns + kSpare];
    if (slice.rowTaps == 2) {
        sumRows<kChannels, 2>(slice, run, columns);
    } else {
        sumRows<kChannels, 0>(slice, run, columns);
    }
    if (slice.columnTaps == 2) {
        sumColumns<kChannels, 2>(run, 2, columns, colors);
    } else {
        sumColumns<kChannels, 0>(run, slice.columnTaps, columns, colors);
    }
}

// Growth takes many steps one after the other, which vectors of all runs share.
template <bool kFrontToBack>
void overScaledColors(const ScaledSlice& slice, std::span<const ScaledRun> runs) {
    HWY_ALIGN float colors[4 * (kMostScaled + kSpare)];
    HWY_ALIGN float steps[kMostScaled + kSpare];
    HWY_ALIGN float growth[kMostScaled + kSpare];
    std::size_t pixels = 0;
    for (const ScaledRun& run : runs) {
        readRun<4>(slice, run, colors + 4 * pixels);
        std::copy_n(run.steps, run.pixels, steps + pixels);
        pixels += std::size_t(run.pixels);
    }
    // Vectors reach over the last pixel.
    std::fill_n(colors + 4 * pixels, 4 * kSpare, 0.0f);
    std::fill_n(steps + pixels, kSpare, 0.0f);
    findGrowth(colors, steps, pixels, growth);
    pixels = 0;
    for (const ScaledRun& run : runs) {
        overGrown<kFrontToBack>(colors + 4 * pixels, growth + pixels, std::size_t(run.pixels),
                                run.layer);
        pixels += std::size_t(run.pixels);
    }
}

template <bool kFrontToBack>
void overScaledOpacities(const ScaledSlice& slice, std::span<const ScaledRun> runs) {
    HWY_ALIGN float opacities[kMostScaled + kSpare];
    for (const ScaledRun& run : runs) {
        readRun<1>(slice, run, opacities);
        std::fill_n(opacities + run.pixels, kSpare, 0.0f);
        overOpacities<kFrontToBack>(opacities, run.steps, std::size_t(run.pixels), run.layer);
    }
}

void overScaledKernel(const ScaledSlice& slice, std::span<const ScaledRun> runs) {
    if (slice.channels == 4)
        return slice.frontToBack ? overScaledColors<true>(slice, runs)
                                 : overScaledColors<false>(slice, runs);
    return slice.frontToBack ? overScaledOpacities<true>(slice, runs)
                             : overScaledOpacities<false>(slice, runs);
}

void repeatOpacityKernel(float* opacities, const float* steps, std::size_t count) {
    const FullTag tag;
    for (std::size_t i = 0; i < count; i += hn::Lanes(tag)) {
        const std::size_t left = std::min(hn::Lanes(tag), count - i);
        HWY_ALIGN float rest[hn::MaxLanes(FullTag())] = {};
        std::copy_n(opacities + i, left, rest);
        const auto repeated = opacityOfSteps(hn::Load(tag, rest), hn::LoadU(tag, steps + i));
        hn::Store(repeated, tag, rest);
        std::copy_n(rest, left, opacities + i);
    }
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(overScaledKernel);
HWY_EXPORT(repeatOpacityKernel);

void ScaledTaps::set(double start, double scale, int firstPixel, int pixels, int size) {
    const double reach = std::max(scale, 1.0);
    taps = scale > 1 ? int(std::ceil(2 * reach)) : 2;
    taps = std::min(taps, std::max(size, 1));
    first.resize(std::size_t(pixels));
    weights.resize(std::size_t(pixels) * std::size_t(taps));
    if (scale <= 1) return setBetween(start, scale, firstPixel, size);
    for (int i = 0; i < pixels; ++i) {
        const double place = start + scale * (firstPixel + i);
        // The first sheet pixel that a tent around the place does not leave out.
        const double lowest = std::floor(place - reach) + 1;
        const int begin = int(std::clamp(lowest, 0.0, double(size - taps)));
        first[std::size_t(i)] = begin;
        float* weight = &weights[std::size_t(i) * std::size_t(taps)];
        // All of the tent counts, also what lies outside of the sheet, where nothing is.
        double sum = 0;
        for (double at = lowest; at < place + reach; ++at) sum += 1 - std::abs(at - place) / reach;
        for (int tap = 0; tap < taps; ++tap) {
            const double share = 1 - std::abs(begin + tap - place) / reach;
            weight[tap] = share > 0 ? float(share / sum) : 0.0f;
        }
    }
}

// Of two neighbours.
void ScaledTaps::setBetween(double start, double scale, int firstPixel, int size) {
    const double most = std::max(size - 2, 0);
    for (std::size_t i = 0; i < first.size(); ++i) {
        const double place = start + scale * (firstPixel + int(i));
        const double begin = std::min(std::max(std::floor(place), 0.0), most);
        const double behind = place - begin;
        first[i] = int(begin);
        weights[std::size_t(taps) * i] = float(std::max(1 - std::abs(behind), 0.0));
        if (taps > 1)
            weights[std::size_t(taps) * i + 1] = float(std::max(1 - std::abs(1 - behind), 0.0));
    }
}

void overScaled(const ScaledSlice& slice, std::span<const ScaledRun> runs) {
    HWY_DYNAMIC_DISPATCH(overScaledKernel)(slice, runs);
}

void repeatOpacity(float* opacities, const float* steps, std::size_t count) {
    HWY_DYNAMIC_DISPATCH(repeatOpacityKernel)(opacities, steps, count);
}

}  // namespace deltasplat
#endif
