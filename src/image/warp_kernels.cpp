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

// Returns the four taps of a row, weighted along y, in `columns`: [4 taps][RGBA].
HWY_INLINE void sumRows(const float* corner, std::size_t pitch, const float* weightY,
                        float* HWY_RESTRICT columns) {
    const RowTag tag;
    for (std::size_t lane = 0; lane < 16; lane += hn::Lanes(tag)) {
        const float* row = corner + lane;
        auto sum = hn::Mul(hn::LoadU(tag, row), hn::Set(tag, weightY[0]));
        for (int j = 1; j < 4; ++j) {
            sum = hn::Add(sum, hn::Mul(hn::LoadU(tag, row + j * pitch), hn::Set(tag, weightY[j])));
        }
        hn::Store(sum, tag, columns + lane);
    }
}

void sampleRunKernel(const Raster& raster, const FourTapTable& table, glm::dvec2 position,
                     glm::dvec2 step, int pixels, float* out) {
    const PixelTag tag;
    const std::size_t pitch = std::size_t{4} * raster.size.x;
    HWY_ALIGN float columns[16];
    for (int i = 0; i < pixels; ++i, out += 4) {
        const double x = position.x + step.x * i;
        const double y = position.y + step.y * i;
        const double wholeX = std::floor(x);
        const double wholeY = std::floor(y);
        const auto& weightX =
            table.repeated[std::size_t((x - wholeX) * FourTapTable::kSteps + 0.5)];
        const auto& weightY = table.plain[std::size_t((y - wholeY) * FourTapTable::kSteps + 0.5)];
        sumRows(
            raster.rgba + (std::ptrdiff_t(wholeY) - 1) * pitch + 4 * (std::ptrdiff_t(wholeX) - 1),
            pitch, weightY.data(), columns);
        auto sum = hn::Mul(hn::Load(tag, columns), hn::LoadU(tag, &weightX[0]));
        for (int tap = 1; tap < 4; ++tap) {
            sum = hn::Add(
                sum, hn::Mul(hn::Load(tag, columns + 4 * tap), hn::LoadU(tag, &weightX[4 * tap])));
        }
        hn::StoreU(sum, tag, out);
    }
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(sampleRunKernel);

void sampleRun(const Raster& raster, const FourTapTable& table, glm::dvec2 position,
               glm::dvec2 step, int pixels, float* out) {
    HWY_DYNAMIC_DISPATCH(sampleRunKernel)(raster, table, position, step, pixels, out);
}

}  // namespace deltasplat
#endif
