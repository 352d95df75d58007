// SPDX-License-Identifier: Apache-2.0
// The warp's inner loop, compiled once for each SIMD level. Sums run in one order whatever a
// vector's width, so that every level gives the same bits.
#include "image/warp_kernels.h"

#include <limits>

#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/warp_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using PixelTag = hn::FixedTag<float, 4>;

using PixelVector = hn::Vec<PixelTag>;

// What a sum along one axis is clamped to: the range of its inner taps.
struct Inner {
    int first, end;
};

// Weighs columns by all rows; kTaps is 0 where it is not known. With kClamp, each is clamped to the
// range of its inner rows.
template <int kTaps, bool kClamp, class Tag>
HWY_INLINE auto sumRows(Tag tag, const float* corner, std::size_t pitch, const float* weightY,
                        int rows, const Inner& inner) {
    auto sum = hn::Mul(hn::LoadU(tag, corner), hn::Set(tag, weightY[0]));
    for (int j = 1; j < (kTaps ? kTaps : rows); ++j) {
        sum = hn::Add(sum, hn::Mul(hn::LoadU(tag, corner + j * pitch), hn::Set(tag, weightY[j])));
    }
    if constexpr (kClamp) {
        const int first = kTaps == 4 ? 1 : inner.first;
        auto low = hn::LoadU(tag, corner + first * pitch);
        auto high = low;
        for (int j = first + 1; j < (kTaps == 4 ? 3 : inner.end); ++j) {
            const auto row = hn::LoadU(tag, corner + j * pitch);
            low = hn::Min(low, row);
            high = hn::Max(high, row);
        }
        sum = hn::Min(hn::Max(sum, low), high);
    }
    return sum;
}

// Sums along a row, tap by tap, the range of the inner taps beside it.
struct ColumnSum {
    PixelVector even, odd, low, high;

    HWY_INLINE void add(PixelVector tap, float weight, bool isOdd, bool isInner) {
        PixelVector& sum = isOdd ? odd : even;
        sum = hn::Add(sum, hn::Mul(tap, hn::Set(PixelTag(), weight)));
        if (!isInner) return;
        low = hn::Min(low, tap);
        high = hn::Max(high, tap);
    }
};

// A pixel of RGBA, or a value in all lanes.
template <int kChannels>
HWY_INLINE PixelVector loadPixel(const float* pixel) {
    const PixelTag tag;
    if constexpr (kChannels == 4) {
        return hn::Load(tag, pixel);
    } else {
        return hn::Set(tag, *pixel);
    }
}

// What becomes of a raster's only channel.
HWY_INLINE PixelVector colorOf(const Raster& raster) {
    HWY_ALIGN const float rgba[4] = {raster.color.x, raster.color.y, raster.color.z, 1};
    return hn::Load(PixelTag(), rgba);
}

// Weighs `kColumns` taps' columns and puts them in a buffer, whatever a vector's width.
template <int kTaps, int kChannels, bool kClamp>
HWY_INLINE void sumColumns(const float* corner, std::size_t pitch, const float* weightY, int rows,
                           const Inner& innerY, float* HWY_RESTRICT columns) {
    using Tag = hn::CappedTag<float, 4 * kChannels>;
    const Tag tag;
    for (int i = 0; i < 4 * kChannels; i += int(hn::Lanes(tag)))
        hn::Store(sumRows<kTaps, kClamp>(tag, corner + i, pitch, weightY, rows, innerY), tag,
                  columns + i);
}

// Returns one pixel: RGBA, or the sum of a single channel in all lanes. kTaps are those along both
// axes, or 0 if they are not four. With kClamp, sums are clamped to their inner taps' range, along
// one axis after the other: so the picture has no jump where inner taps change.
template <int kTaps, int kChannels, bool kClamp>
HWY_INLINE PixelVector samplePixel(const FilterView& filterX, std::uint32_t x, const float* corner,
                                   std::size_t pitch, const float* weightY, int rows,
                                   const Inner& innerX, const Inner& innerY) {
    HWY_ALIGN float columns[4 * kChannels];
    const float* weightX = filterX.weights(x);
    const PixelTag tag;
    const float infinity = std::numeric_limits<float>::infinity();
    ColumnSum sum{hn::Zero(tag), hn::Zero(tag), hn::Set(tag, infinity), hn::Set(tag, -infinity)};
    for (int first = 0; first < (kTaps ? kTaps : filterX.paddedTaps()); first += 4) {
        sumColumns<kTaps, kChannels, kClamp>(corner + kChannels * first, pitch, weightY, rows,
                                             innerY, columns);
        for (int tap = 0; tap < 4; ++tap) {
            const int at = first + tap;
            const bool isInner =
                kClamp && (kTaps == 4 ? at == 1 || at == 2 : at >= innerX.first && at < innerX.end);
            sum.add(loadPixel<kChannels>(columns + kChannels * tap), weightX[at], tap % 2 != 0,
                    isInner);
        }
    }
    const PixelVector all = hn::Add(sum.even, sum.odd);
    return kClamp ? hn::Min(hn::Max(all, sum.low), sum.high) : all;
}

// Positions of a run of pixels: evenly spaced ones, and any.
struct EvenPositions {
    FixedPosition position, step;

    FixedPosition next() {
        const FixedPosition here = position;
        position.x += step.x;
        position.y += step.y;
        return here;
    }
};
struct AnyPositions {
    const FixedPosition* position;

    FixedPosition next() { return *position++; }
};

// What is sampled.
struct Sampling {
    const Raster& raster;
    const FilterTable& filterX;
    const FilterTable& filterY;
    int pixels;
    float* out;
};

template <int kTaps, int kChannels, bool kClamp, class Positions>
void sampleOf(const Sampling& what, Positions positions) {
    const PixelTag tag;
    const Raster& raster = what.raster;
    const std::size_t pitch = std::size_t(kChannels) * raster.size.x;
    // Copies, so that what is written cannot be thought to change them.
    const FilterView filterX(what.filterX);
    const FilterView filterY(what.filterY);
    const auto innerOf = [](const FilterView& filter) {
        return Inner{filter.firstInnerTap(), filter.firstInnerTap() + filter.innerTaps()};
    };
    const Inner innerX = innerOf(filterX);
    const Inner innerY = innerOf(filterY);
    const PixelVector color = colorOf(raster);
    float* out = what.out;
    for (int i = 0; i < what.pixels; ++i, out += 4) {
        const FixedPosition position = positions.next();
        const float* corner = raster.values + filterY.firstTap(int(position.y >> 32)) * pitch +
                              kChannels * filterX.firstTap(int(position.x >> 32));
        PixelVector sum = samplePixel<kTaps, kChannels, kClamp>(
            filterX, std::uint32_t(position.x), corner, pitch,
            filterY.weights(std::uint32_t(position.y)), filterY.taps(), innerX, innerY);
        if constexpr (kChannels == 1) sum = hn::Mul(sum, color);
        hn::StoreU(sum, tag, out);
    }
}

template <int kChannels, bool kClamp, class Positions>
void sampleOf(const Sampling& what, Positions positions) {
    // Of four, two are inner ones.
    const auto isFour = [](const FilterView& filter) {
        return filter.taps() == 4 && filter.innerTaps() == 2;
    };
    const bool four = isFour(what.filterX) && isFour(what.filterY);
    return four ? sampleOf<4, kChannels, kClamp>(what, positions)
                : sampleOf<0, kChannels, kClamp>(what, positions);
}

template <int kChannels, class Positions>
void sampleOf(const Sampling& what, Positions positions) {
    return what.filterX.overshoots() ? sampleOf<kChannels, true>(what, positions)
                                     : sampleOf<kChannels, false>(what, positions);
}

template <class Positions>
void sampleOf(const Sampling& what, Positions positions) {
    return what.raster.channels == 4 ? sampleOf<4>(what, positions) : sampleOf<1>(what, positions);
}

void sampleRunKernel(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
                     FixedPosition position, FixedPosition step, int pixels, float* out) {
    sampleOf({raster, filterX, filterY, pixels, out}, EvenPositions{position, step});
}

void sampleAtKernel(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
                    const FixedPosition* positions, int pixels, float* out) {
    sampleOf({raster, filterX, filterY, pixels, out}, AnyPositions{positions});
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(sampleRunKernel);
HWY_EXPORT(sampleAtKernel);

void sampleRun(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
               FixedPosition position, FixedPosition step, int pixels, float* out) {
    HWY_DYNAMIC_DISPATCH(sampleRunKernel)
    (raster, filterX, filterY, position, step, pixels, out);
}

void sampleAt(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
              const FixedPosition* positions, int pixels, float* out) {
    HWY_DYNAMIC_DISPATCH(sampleAtKernel)(raster, filterX, filterY, positions, pixels, out);
}

}  // namespace deltasplat
#endif
