// SPDX-License-Identifier: Apache-2.0
// The warp's inner loop, compiled once for each SIMD level: four taps of RGBA are 16 floats, one to
// four vectors. Sums run in one order whatever the width, so that every level gives the same bits.
#include "image/warp_kernels.h"

#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/warp_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using RowTag = hn::CappedTag<float, 16>;
using PixelTag = hn::FixedTag<float, 4>;

using PixelVector = hn::Vec<PixelTag>;

// Weighs four neighbouring lanes' worth of a column by all rows. kTaps is 0 where it is not known.
template <int kTaps, class Tag>
HWY_INLINE auto sumRows(Tag tag, const float* corner, std::size_t pitch, const float* weightY,
                        int rows) {
    auto sum = hn::Mul(hn::LoadU(tag, corner), hn::Set(tag, weightY[0]));
    for (int j = 1; j < (kTaps ? kTaps : rows); ++j) {
        sum = hn::Add(sum, hn::Mul(hn::LoadU(tag, corner + j * pitch), hn::Set(tag, weightY[j])));
    }
    return sum;
}

// Adds four taps of RGBA up: (first + third) + (second + fourth), whatever a vector's width.
template <int kTaps>
HWY_INLINE PixelVector sumTaps(const float* corner, std::size_t pitch, const float* weightX,
                               const float* weightY, int rows) {
    const RowTag tag;
    const auto part = [&](int tap) {
        return hn::Mul(sumRows<kTaps>(tag, corner + 4 * tap, pitch, weightY, rows),
                       hn::LoadU(tag, weightX + 4 * tap));
    };
#if HWY_MAX_BYTES >= 64
    if constexpr (hn::MaxLanes(tag) == 16) {
        const hn::Half<RowTag> half;
        const hn::Half<hn::Half<RowTag>> quarter;
        const auto all = part(0);
        const auto pairs = hn::Add(hn::LowerHalf(half, all), hn::UpperHalf(half, all));
        return hn::Add(hn::LowerHalf(quarter, pairs), hn::UpperHalf(quarter, pairs));
    }
#elif HWY_MAX_BYTES >= 32
    if constexpr (hn::MaxLanes(tag) == 8) {
        const hn::Half<RowTag> half;
        const auto pairs = hn::Add(part(0), part(2));
        return hn::Add(hn::LowerHalf(half, pairs), hn::UpperHalf(half, pairs));
    }
#else
    return hn::Add(hn::Add(part(0), part(2)), hn::Add(part(1), part(3)));
#endif
}

// The same for four taps of opacity; all lanes of the result are the sum.
template <int kTaps>
HWY_INLINE PixelVector sumOpacities(const float* corner, std::size_t pitch, const float* weightX,
                                    const float* weightY, int rows) {
    const PixelTag tag;
    const auto taps =
        hn::Mul(sumRows<kTaps>(tag, corner, pitch, weightY, rows), hn::LoadU(tag, weightX));
    const auto pairs = hn::Add(taps, hn::Shuffle1032(taps));
    return hn::Add(pairs, hn::Shuffle2301(pairs));
}

// A pixel of RGBA, or a value in all lanes.
template <int kChannels>
HWY_INLINE PixelVector loadPixel(const float* pixel) {
    const PixelTag tag;
    if constexpr (kChannels == 4) {
        return hn::LoadU(tag, pixel);
    } else {
        return hn::Set(tag, *pixel);
    }
}

// Inner taps, counted from the first of all.
struct InnerTaps {
    InnerTaps(const FilterView& filterX, const FilterView& filterY)
        : firstX(filterX.firstInnerTap()),
          firstY(filterY.firstInnerTap()),
          countX(filterX.innerTaps()),
          countY(filterY.innerTaps()) {}
    int firstX, firstY, countX, countY;
};

// Clamps a sum to the range of the inner taps: two by two if kTaps is four.
template <int kTaps, int kChannels>
HWY_INLINE PixelVector clampToInner(PixelVector sum, const float* corner, std::size_t pitch,
                                    const InnerTaps& inner) {
    const int columns = kTaps == 4 ? 2 : inner.countX;
    const int rows = kTaps == 4 ? 2 : inner.countY;
    const float* row = corner + (kTaps == 4 ? 1 : inner.firstY) * pitch +
                       kChannels * (kTaps == 4 ? 1 : inner.firstX);
    PixelVector low = loadPixel<kChannels>(row);
    PixelVector high = low;
    for (int y = 0; y < rows; ++y, row += pitch) {
        for (int x = 0; x < columns; ++x) {
            const PixelVector tap = loadPixel<kChannels>(row + kChannels * x);
            low = hn::Min(low, tap);
            high = hn::Max(high, tap);
        }
    }
    return hn::Min(hn::Max(sum, low), high);
}

// What becomes of a raster's only channel.
HWY_INLINE PixelVector colorOf(const Raster& raster) {
    HWY_ALIGN const float rgba[4] = {raster.color.x, raster.color.y, raster.color.z, 1};
    return hn::Load(PixelTag(), rgba);
}

// Returns one pixel: RGBA, or the sum of a single channel in all lanes. kTaps are those along both
// axes, or 0 if they are not four.
template <int kTaps, int kChannels>
HWY_INLINE PixelVector samplePixel(const FilterView& filterX, std::uint32_t x, const float* corner,
                                   std::size_t pitch, const float* weightY, int rows) {
    const float* weightX = kChannels == 4 ? filterX.wideWeights(x) : filterX.weights(x);
    auto sum = hn::Zero(PixelTag());
    for (int first = 0; first < (kTaps ? kTaps : filterX.paddedTaps()); first += 4) {
        const float* taps = corner + kChannels * first;
        if constexpr (kChannels == 4) {
            sum = hn::Add(sum, sumTaps<kTaps>(taps, pitch, weightX + 4 * first, weightY, rows));
        } else {
            sum = hn::Add(sum, sumOpacities<kTaps>(taps, pitch, weightX + first, weightY, rows));
        }
    }
    return sum;
}

template <int kTaps, int kChannels>
void sampleRunOf(const Raster& raster, const FilterTable& wantedX, const FilterTable& wantedY,
                 FixedPosition position, FixedPosition step, int pixels, float* out) {
    const PixelTag tag;
    const std::size_t pitch = std::size_t(kChannels) * raster.size.x;
    // Copies, so that what is written cannot be thought to change them.
    const FilterView filterX(wantedX);
    const FilterView filterY(wantedY);
    const InnerTaps inner(filterX, filterY);
    const bool overshoots = filterX.overshoots();
    const PixelVector color = colorOf(raster);
    for (int i = 0; i < pixels; ++i, out += 4) {
        const float* corner = raster.values + filterY.firstTap(int(position.y >> 32)) * pitch +
                              kChannels * filterX.firstTap(int(position.x >> 32));
        PixelVector sum = samplePixel<kTaps, kChannels>(
            filterX, std::uint32_t(position.x), corner, pitch,
            filterY.weights(std::uint32_t(position.y)), filterY.taps());
        if (overshoots) sum = clampToInner<kTaps, kChannels>(sum, corner, pitch, inner);
        if constexpr (kChannels == 1) sum = hn::Mul(sum, color);
        hn::StoreU(sum, tag, out);
        position.x += step.x;
        position.y += step.y;
    }
}

template <int kChannels>
void sampleRunOf(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
                 FixedPosition position, FixedPosition step, int pixels, float* out) {
    const bool four = filterX.taps() == 4 && filterY.taps() == 4;
    return four ? sampleRunOf<4, kChannels>(raster, filterX, filterY, position, step, pixels, out)
                : sampleRunOf<0, kChannels>(raster, filterX, filterY, position, step, pixels, out);
}

void sampleRunKernel(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
                     FixedPosition position, FixedPosition step, int pixels, float* out) {
    return raster.channels == 4
               ? sampleRunOf<4>(raster, filterX, filterY, position, step, pixels, out)
               : sampleRunOf<1>(raster, filterX, filterY, position, step, pixels, out);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(sampleRunKernel);

void sampleRun(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
               FixedPosition position, FixedPosition step, int pixels, float* out) {
    HWY_DYNAMIC_DISPATCH(sampleRunKernel)
    (raster, filterX, filterY, position, step, pixels, out);
}

}  // namespace deltasplat
#endif
