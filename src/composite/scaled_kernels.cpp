// SPDX-License-Identifier: Apache-2.0
// The inner loops of perspective compositing, compiled once for each SIMD level.
#include "composite/scaled_kernels.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "composite/scaled_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "optics/opacity_steps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using PixelTag = hn::FixedTag<float, 4>;

// Columns and pixels are worked on in whole vectors, which may reach over the last.
constexpr std::size_t kSpare = hn::MaxLanes(FullTag()) < 16 ? 16 : hn::MaxLanes(FullTag());

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
    const std::size_t count = std::size_t{kChannels} * std::size_t(run.columns(slice.columnTaps));
    for (std::size_t p = 0; p < slice.scales.size(); ++p) {
        const auto scale = loadScale<kChannels>(tag, slice.scales[p]);
        const auto weight = [&](int n) { return hn::Mul(scale, hn::Set(tag, run.rowWeights[n])); };
        const auto firstWeight = weight(0);
        const auto secondWeight = weight(kRows == 2 ? 1 : 0);
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
                    sum = hn::Add(sum, hn::Mul(row(n), weight(n)));
            }
            if (p > 0) sum = hn::Add(hn::LoadU(tag, columns + i), sum);
            hn::StoreU(sum, tag, columns + i);
        }
    }
}

// Which lanes hold what pixels and channels have, in a vector of kChannels a pixel.
template <int kChannels>
struct PixelLanes {
    static constexpr std::size_t kMost = hn::MaxLanes(FullTag());
    HWY_ALIGN std::int32_t pixel[kMost];
    HWY_ALIGN std::int32_t channel[kMost];

    PixelLanes() {
        for (std::size_t i = 0; i < hn::Lanes(FullTag()); ++i) {
            pixel[i] = std::int32_t(i) / kChannels;
            channel[i] = std::int32_t(i) % kChannels;
        }
    }
};

// Weighs two neighbouring columns for every pixel. As columns lie no closer than pixels do, those
// of a vector of pixels lie within a vector.
template <int kChannels>
HWY_INLINE void sumColumnPairs(const ScaledRun& run, const float* columns, float* colors) {
    const FullTag tag;
    const hn::RebindToSigned<FullTag> whole;
    const PixelLanes<kChannels> lanes;
    const auto pixelOf = hn::SetTableIndices(tag, lanes.pixel);
    const auto wholePixelOf = hn::SetTableIndices(whole, lanes.pixel);
    const auto channel = hn::Load(whole, lanes.channel);
    const std::size_t perVector = hn::Lanes(tag) / kChannels;
    const auto ofPixels = [&](auto values) {
        if constexpr (kChannels == 1) {
            return values;
        } else if constexpr (std::is_same_v<decltype(values), Vector>) {
            return hn::TableLookupLanes(values, pixelOf);
        } else {
            return hn::TableLookupLanes(values, wholePixelOf);
        }
    };
    for (std::size_t x = 0; x < std::size_t(run.pixels); x += perVector) {
        const std::int32_t first = run.first[x];
        const float* column = columns + kChannels * (first - run.first[0]);
        const auto away = hn::Sub(hn::LoadU(whole, run.first + x), hn::Set(whole, first));
        auto lane = ofPixels(away);
        if constexpr (kChannels == 4) lane = hn::Add(hn::ShiftLeft<2>(lane), channel);
        const auto from = hn::IndicesFromVec(tag, lane);
        const auto weight = ofPixels(hn::LoadU(tag, run.pairWeights + x));
        const auto here = hn::TableLookupLanes(hn::LoadU(tag, column), from);
        const auto next = hn::TableLookupLanes(hn::LoadU(tag, column + kChannels), from);
        const auto rest = hn::Sub(constant(1), weight);
        hn::StoreU(hn::Add(hn::Mul(here, weight), hn::Mul(next, rest)), tag,
                   colors + kChannels * x);
    }
}

// Weighs the columns of every pixel.
template <int kChannels>
HWY_INLINE void sumColumns(const ScaledRun& run, int taps, const float* columns, float* colors) {
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
        hn::StoreU(growthOfSteps(opacity, hn::LoadU(tag, steps + i)), tag, growth + i);
    }
}

// As many values as the tag has lanes.
template <class Tag, class V>
HWY_INLINE void overColors(Tag tag, V color, float* layer) {
    const auto front = hn::LoadU(tag, layer);
    const auto clear = hn::Sub(hn::Set(tag, 1.0f), hn::Broadcast<3>(front));
    hn::StoreU(hn::Add(front, hn::Mul(clear, color)), tag, layer);
}

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
        overColors(tag, hn::Mul(hn::LoadU(tag, colors + 4 * i), times), layer + 4 * i);
    }
    const PixelTag one;
    for (; i < pixels; ++i) {
        const auto color = hn::Mul(hn::LoadU(one, colors + 4 * i), hn::Set(one, growth[i]));
        overColors(one, color, layer + 4 * i);
    }
}

HWY_INLINE void overOpacities(const float* opacities, const float* steps, std::size_t pixels,
                              float* layer) {
    const FullTag tag;
    HWY_ALIGN float rest[hn::MaxLanes(FullTag())] = {};
    for (std::size_t i = 0; i < pixels; i += hn::Lanes(tag)) {
        auto color = hn::LoadU(tag, opacities + i);
        if (steps) color = opacityOfSteps(color, hn::LoadU(tag, steps + i));
        const std::size_t count = std::min(hn::Lanes(tag), pixels - i);
        const bool isWhole = count == hn::Lanes(tag);
        if (!isWhole) std::copy_n(layer + i, count, rest);
        const auto front = hn::LoadU(tag, isWhole ? layer + i : rest);
        const auto sum = mulAdd(hn::Sub(constant(1), front), color, front);
        hn::StoreU(sum, tag, isWhole ? layer + i : rest);
        if (!isWhole) std::copy_n(rest, count, layer + i);
    }
}

template <int kChannels>
HWY_INLINE void readRun(const ScaledSlice& slice, const ScaledRun& run, float* colors) {
    HWY_ALIGN float columns[kChannels * kMostScaledColumns + 2 * kSpare];
    if (slice.rowTaps == 2) {
        sumRows<kChannels, 2>(slice, run, columns);
    } else {
        sumRows<kChannels, 0>(slice, run, columns);
    }
    if (run.pairWeights) return sumColumnPairs<kChannels>(run, columns, colors);
    sumColumns<kChannels>(run, slice.columnTaps, columns, colors);
}

void overScaledColors(const ScaledSlice& slice, const ScaledRun& run) {
    HWY_ALIGN float colors[4 * (kMostScaled + kSpare)];
    HWY_ALIGN float growth[kMostScaled + kSpare];
    const auto pixels = std::size_t(run.pixels);
    readRun<4>(slice, run, colors);
    // Vectors reach over the last pixel.
    std::fill_n(colors + 4 * pixels, 4 * kSpare, 0.0f);
    findGrowth(colors, run.steps, pixels, growth);
    overGrown(colors, growth, pixels, run.layer);
}

void overScaledOpacities(const ScaledSlice& slice, const ScaledRun& run) {
    HWY_ALIGN float opacities[kMostScaled + kSpare];
    readRun<1>(slice, run, opacities);
    std::fill_n(opacities + run.pixels, kSpare, 0.0f);
    overOpacities(opacities, run.steps, std::size_t(run.pixels), run.layer);
}

void overScaledKernel(const ScaledSlice& slice, std::span<const ScaledRun> runs) {
    const auto over = slice.channels == 4 ? overScaledColors : overScaledOpacities;
    for (const ScaledRun& run : runs) over(slice, run);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(overScaledKernel);

void ScaledTaps::set(double start, double scale, int firstPixel, int pixels, const Part& part) {
    const double reach = std::max(scale, 1.0);
    taps = scale > 1 ? std::min(int(std::ceil(2 * reach)), part.size) : 2;
    first.resize(std::size_t(pixels));
    weights.resize(std::size_t(pixels) * std::size_t(taps));
    if (scale <= 1) return setBetween(start, scale, firstPixel, part);
    pairs.clear();
    for (int i = 0; i < pixels; ++i) {
        const double place = start + scale * (firstPixel + i);
        // The first sheet pixel that a tent around the place does not leave out.
        const double lowest = std::floor(place - reach) + 1;
        const double least = part.origin;
        const int begin = int(std::clamp(lowest, least, least + (part.size - taps)));
        first[std::size_t(i)] = begin - part.origin;
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
void ScaledTaps::setBetween(double start, double scale, int firstPixel, const Part& part) {
    const double least = part.origin;
    const double most = least + (part.size - 2);
    pairs.resize(first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        const double place = start + scale * (firstPixel + int(i));
        double begin = std::min(std::max(std::floor(place), least), most);
        // Rounding of places must not take two steps at once, which no scale up to 1 does.
        if (i > 0) begin = std::min(begin, least + first[i - 1] + 1);
        const double behind = place - begin;
        first[i] = int(begin) - part.origin;
        // Beyond the sheet's edge, where it is zero, it does not matter what is read.
        pairs[i] = float(std::clamp(1 - behind, 0.0, 1.0));
        weights[2 * i] = pairs[i];
        weights[2 * i + 1] = 1 - pairs[i];
    }
    const std::size_t pixels = first.size();
    first.resize(pixels + kSpare, first.back());
    pairs.resize(pixels + kSpare, 1);
}

void overScaled(const ScaledSlice& slice, std::span<const ScaledRun> runs) {
    HWY_DYNAMIC_DISPATCH(overScaledKernel)(slice, runs);
}

}  // namespace deltasplat
#endif
