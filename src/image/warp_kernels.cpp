// SPDX-License-Identifier: Apache-2.0
// The warp's inner loop, compiled once for each SIMD level: four taps of RGBA are 16 floats, one to
// four vectors. Sums run in one order whatever the width, so that every level gives the same bits.
#include "image/warp_kernels.h"

#include <cmath>

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

// Weighs four neighbouring taps by all rows, and leaves them in `columns`: [4 taps][RGBA].
HWY_INLINE void sumRows(const float* corner, std::size_t pitch, const float* weightY, int rows,
                        float* HWY_RESTRICT columns) {
    const RowTag tag;
    for (std::size_t lane = 0; lane < 16; lane += hn::Lanes(tag)) {
        const float* row = corner + lane;
        auto sum = hn::Mul(hn::LoadU(tag, row), hn::Set(tag, weightY[0]));
        for (int j = 1; j < rows; ++j) {
            row += pitch;
            sum = hn::Add(sum, hn::Mul(hn::LoadU(tag, row), hn::Set(tag, weightY[4 * j])));
        }
        hn::Store(sum, tag, columns + lane);
    }
}

// One pixel: rows first, then the columns that are left, four at a time. kRows is 0 where it is not
// known.
template <int kRows>
HWY_INLINE void samplePixel(const float* corner, std::size_t pitch, const FilterTable& filterX,
                            const float* weightX, const float* weightY, int rows, float* out) {
    const PixelTag tag;
    HWY_ALIGN float columns[16];
    auto sum = hn::Zero(tag);
    for (int first = 0; first < filterX.paddedTaps(); first += 4) {
        sumRows(corner + 4 * first, pitch, weightY, kRows ? kRows : rows, columns);
        for (int tap = 0; tap < 4; ++tap) {
            sum = hn::Add(sum, hn::Mul(hn::Load(tag, columns + 4 * tap),
                                       hn::LoadU(tag, weightX + 4 * (first + tap))));
        }
    }
    hn::StoreU(sum, tag, out);
}

template <int kRows>
void sampleRunOf(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
                 glm::dvec2 position, glm::dvec2 step, int pixels, float* out) {
    const std::size_t pitch = std::size_t{4} * raster.size.x;
    for (int i = 0; i < pixels; ++i, out += 4) {
        const glm::dvec2 p(position.x + step.x * i, position.y + step.y * i);
        const int wholeX = int(std::floor(p.x));
        const int wholeY = int(std::floor(p.y));
        const float* corner = raster.rgba + filterY.firstTap(wholeY) * pitch +
                              std::size_t{4} * filterX.firstTap(wholeX);
        samplePixel<kRows>(corner, pitch, filterX, filterX.weights(p.x - wholeX),
                           filterY.weights(p.y - wholeY), filterY.taps(), out);
    }
}

void sampleRunKernel(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
                     glm::dvec2 position, glm::dvec2 step, int pixels, float* out) {
    switch (filterY.taps()) {
        case 4:
            return sampleRunOf<4>(raster, filterX, filterY, position, step, pixels, out);
        case 6:
            return sampleRunOf<6>(raster, filterX, filterY, position, step, pixels, out);
        default:
            return sampleRunOf<0>(raster, filterX, filterY, position, step, pixels, out);
    }
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(sampleRunKernel);

void sampleRun(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
               glm::dvec2 position, glm::dvec2 step, int pixels, float* out) {
    HWY_DYNAMIC_DISPATCH(sampleRunKernel)
    (raster, filterX, filterY, position, step, pixels, out);
}

}  // namespace deltasplat
#endif
