// SPDX-License-Identifier: Apache-2.0
// The inner loops of perspective compositing, compiled once per SIMD level.
#include "composite/scaled_kernels.h"

#include <algorithm>
#include <cmath>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "composite/scaled_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "base/opacity_steps-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using PixelTag = hn::FixedTag<float, 4>;

// Spare columns and pixels for vectors that reach over the last.
constexpr std::size_t kSpare = hn::MaxLanes(FullTag()) < 16 ? 16 : hn::MaxLanes(FullTag());

template <int kChannels, class Tag>
HWY_INLINE auto loadScale(Tag tag, const glm::vec4& scale) {
    if constexpr (kChannels == 4) {
        return hn::LoadDup128(tag, &scale.x);
    } else {
        return hn::Set(tag, scale.w);
    }
}

// Weighs the rows of every column; kRows is 0 if unknown.
template <int kChannels, int kRows>
HWY_INLINE void sumSomeRows(const ScaledSlice& slice, const ScaledRun& run, float* columns) {
    // Limited to a sheet row's spare pixels.
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
    // Zeros that vectors of pixels read behind the last column.
    const std::size_t end = (count + hn::Lanes(tag) - 1) / hn::Lanes(tag) * hn::Lanes(tag);
    std::fill_n(columns + end, 2 * kSpare, 0.0f);
}

// Interpolates two neighbouring columns per lane.
// @param from  the lane of the first column for each result
template <class Indices>
HWY_INLINE Vector weighPair(const float* column, std::size_t channels, Indices from,
                            Vector weight) {
    const FullTag tag;
    const auto here = hn::TableLookupLanes(hn::LoadU(tag, column), from);
    const auto next = hn::TableLookupLanes(hn::LoadU(tag, column + channels), from);
    return hn::Add(hn::Mul(here, weight), hn::Mul(next, hn::Sub(constant(1), weight)));
}

// Interpolates two neighbouring columns for every pixel, of one channel. Columns are not closer
// than pixels, so a vector of pixels reads from one vector of columns.
HWY_INLINE void sumColumnPairs(const ScaledRun& run, const float* columns, float* opacities) {
    const FullTag tag;
    const hn::RebindToSigned<FullTag> whole;
    for (std::size_t x = 0; x < std::size_t(run.pixels); x += hn::Lanes(tag)) {
        const std::int32_t first = run.first[x];
        const float* column = columns + (first - run.first[0]);
        const auto away = hn::Sub(hn::LoadU(whole, run.first + x), hn::Set(whole, first));
        const auto from = hn::IndicesFromVec(tag, away);
        const auto weight = hn::LoadU(tag, run.pairWeights + x);
        hn::StoreU(weighPair(column, 1, from, weight), tag, opacities + x);
    }
}

// Lane numbers that spread pixels' values over vectors of their colours, for many runs.
struct ColorLanes {
    static constexpr std::size_t kMost = hn::MaxLanes(FullTag());
    using Indices = decltype(hn::SetTableIndices(FullTag(), static_cast<std::int32_t*>(nullptr)));

    static std::size_t perVector() { return hn::Lanes(FullTag()) / 4; }

    ColorLanes() {
        HWY_ALIGN std::int32_t lane[kMost];
        for (std::size_t n = 0; n < 4; ++n) {
            for (std::size_t i = 0; i < hn::Lanes(FullTag()); ++i)
                lane[i] = std::int32_t(n * perVector() + i / 4);
            pixelOf[n] = hn::SetTableIndices(FullTag(), lane);
        }
        for (std::size_t i = 0; i < hn::Lanes(FullTag()); ++i) lane[i] = std::int32_t(i % 4);
        channel = hn::Load(hn::RebindToSigned<FullTag>(), lane);
    }

    Indices pixelOf[4];  // [vector]: pixel of each lane
    hn::Vec<hn::RebindToSigned<FullTag>> channel;
};

// Colours of a vector's lanes of pixels, initially clear.
struct FourColors {
    // A compiler-made constructor would be for another target.
    HWY_INLINE FourColors() {
        for (Vector& color : of) color = hn::Zero(FullTag());
    }

    Vector of[4];

    Vector opacities() const {
        const FullTag tag;
        // Every fourth: the opacities.
        return hn::ConcatOdd(tag, hn::ConcatOdd(tag, of[3], of[2]),
                             hn::ConcatOdd(tag, of[1], of[0]));
    }
};

// Interpolates two neighbouring columns for the pixels of `vectors` vectors from x on. Columns are
// not closer than pixels, so a vector of pixels reads from one vector of columns.
HWY_INLINE FourColors pairColors(const ScaledRun& run, const float* columns,
                                 const ColorLanes& lanes, std::size_t x, std::size_t vectors) {
    const FullTag tag;
    const hn::RebindToSigned<FullTag> whole;
    const auto firsts = hn::LoadU(whole, run.first + x);
    const auto weights = hn::LoadU(tag, run.pairWeights + x);
    FourColors colors;
    for (std::size_t n = 0; n < 4; ++n) {
        if (n >= vectors) continue;
        const std::int32_t first = run.first[x + n * ColorLanes::perVector()];
        const float* column = columns + 4 * (first - run.first[0]);
        const auto away = hn::BitCast(
            whole, hn::TableLookupLanes(hn::BitCast(tag, hn::Sub(firsts, hn::Set(whole, first))),
                                        lanes.pixelOf[n]));
        const auto from = hn::IndicesFromVec(tag, hn::Add(hn::ShiftLeft<2>(away), lanes.channel));
        const auto weight = hn::TableLookupLanes(weights, lanes.pixelOf[n]);
        colors.of[n] = weighPair(column, 4, from, weight);
    }
    return colors;
}

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

// Puts one vector of values behind a layer.
template <class Tag>
HWY_INLINE void overColors(Tag tag, hn::Vec<Tag> color, float* layer) {
    const auto front = hn::LoadU(tag, layer);
    const auto clear = hn::Sub(hn::Set(tag, 1.0f), hn::Broadcast<3>(front));
    hn::StoreU(hn::Add(front, hn::Mul(clear, color)), tag, layer);
}

// Scales light and opacity to steps.
// @param steps  of the first pixel
HWY_INLINE void grow(const ColorLanes& lanes, const float* steps, FourColors& colors) {
    const auto growth = growthOfSteps(colors.opacities(), hn::LoadU(FullTag(), steps));
    for (std::size_t n = 0; n < 4; ++n)
        colors.of[n] = hn::Mul(colors.of[n], hn::TableLookupLanes(growth, lanes.pixelOf[n]));
}

// Puts the colours of all pixels of a run behind the layer.
// @param colorsAt  colorsAt(x, vectors): this many vectors from pixel x on, others zero
template <class ColorsAt>
HWY_INLINE void overAll(const ScaledRun& run, const ColorLanes& lanes, const ColorsAt& colorsAt) {
    const FullTag tag;
    const std::size_t lanesOf = hn::Lanes(tag);
    const auto pixels = std::size_t(run.pixels);
    float* layer = run.layer;
    std::size_t x = 0;
    for (; x + lanesOf <= pixels; x += lanesOf) {
        FourColors colors = colorsAt(x, std::size_t{4});
        grow(lanes, run.steps + x, colors);
        for (const Vector& color : colors.of) {
            overColors(tag, color, layer);
            layer += lanesOf;
        }
    }
    if (x == pixels) return;
    FourColors colors = colorsAt(x, (pixels - x - 1) / ColorLanes::perVector() + 1);
    grow(lanes, run.steps + x, colors);
    std::size_t n = 0;
    for (; x + ColorLanes::perVector() <= pixels; x += ColorLanes::perVector()) {
        overColors(tag, colors.of[n++], layer);
        layer += lanesOf;
    }
    if (x == pixels) return;
    HWY_ALIGN float rest[ColorLanes::kMost];
    hn::Store(colors.of[n], tag, rest);
    const PixelTag one;
    for (std::size_t i = 0; x < pixels; ++x, i += 4)
        overColors(one, hn::Load(one, rest + i), layer + i);
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
HWY_INLINE void sumRows(const ScaledSlice& slice, const ScaledRun& run, float* columns) {
    if (slice.rowTaps == 2) {
        sumSomeRows<kChannels, 2>(slice, run, columns);
    } else {
        sumSomeRows<kChannels, 0>(slice, run, columns);
    }
}

void overScaledColors(const ScaledSlice& slice, const ScaledRun& run, const ColorLanes& lanes) {
    HWY_ALIGN float columns[4 * kMostScaledColumns + 3 * kSpare];
    sumRows<4>(slice, run, columns);
    if (run.pairWeights) {
        overAll(run, lanes, [&](std::size_t x, std::size_t vectors) {
            return pairColors(run, columns, lanes, x, vectors);
        });
        return;
    }
    HWY_ALIGN float values[4 * (kMostScaled + kSpare)];
    sumColumns<4>(run, slice.columnTaps, columns, values);
    // Vectors reach over the last pixel.
    std::fill_n(values + 4 * run.pixels, 4 * kSpare, 0.0f);
    overAll(run, lanes, [&](std::size_t x, std::size_t) {
        FourColors colors;
        for (std::size_t n = 0; n < 4; ++n)
            colors.of[n] = hn::LoadU(FullTag(), values + 4 * x + n * hn::Lanes(FullTag()));
        return colors;
    });
}

void overScaledOpacities(const ScaledSlice& slice, const ScaledRun& run) {
    HWY_ALIGN float columns[kMostScaledColumns + 3 * kSpare];
    HWY_ALIGN float opacities[kMostScaled + kSpare];
    sumRows<1>(slice, run, columns);
    if (run.pairWeights) {
        sumColumnPairs(run, columns, opacities);
    } else {
        sumColumns<1>(run, slice.columnTaps, columns, opacities);
    }
    std::fill_n(opacities + run.pixels, kSpare, 0.0f);
    overOpacities(opacities, run.steps, std::size_t(run.pixels), run.layer);
}

void overScaledKernel(const ScaledSlice& slice, std::span<const ScaledRun> runs) {
    if (slice.channels == 1) {
        for (const ScaledRun& run : runs) overScaledOpacities(slice, run);
        return;
    }
    const ColorLanes lanes;
    for (const ScaledRun& run : runs) overScaledColors(slice, run, lanes);
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
        // The first sheet pixel inside a tent around the place.
        const double lowest = std::floor(place - reach) + 1;
        const double least = part.origin;
        const int begin = int(std::clamp(lowest, least, least + (part.size - taps)));
        first[std::size_t(i)] = begin - part.origin;
        float* weight = &weights[std::size_t(i) * std::size_t(taps)];
        // The sum includes the tent outside the sheet, where everything is zero.
        double sum = 0;
        for (double at = lowest; at < place + reach; ++at) sum += 1 - std::abs(at - place) / reach;
        for (int tap = 0; tap < taps; ++tap) {
            const double share = 1 - std::abs(begin + tap - place) / reach;
            weight[tap] = share > 0 ? float(share / sum) : 0.0f;
        }
    }
}

void ScaledTaps::setBetween(double start, double scale, int firstPixel, const Part& part) {
    const double least = part.origin;
    const double most = least + (part.size - 2);
    pairs.resize(first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        const double place = start + scale * (firstPixel + int(i));
        double begin = std::min(std::max(std::floor(place), least), most);
        // A scale up to 1 never takes two steps at once; rounding must not either.
        if (i > 0) begin = std::min(begin, least + first[i - 1] + 1);
        const double behind = place - begin;
        first[i] = int(begin) - part.origin;
        // Beyond the sheet's edge everything read is zero.
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
