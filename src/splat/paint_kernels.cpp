// SPDX-License-Identifier: Apache-2.0
// Looks up colours and interleaves those of two rows, compiled once per SIMD level.
#include "splat/paint_kernels.h"

#include <bit>
#include <cstring>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splat/paint_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Calls use(u, v) for pairs (u, v) and (u + 1, v), u even, with any of `voxels`, or for all.
template <typename Use>
HWY_INLINE void forPairs(std::uint64_t voxels, const Use& use) {
    // For most pairs, a loop over all is faster.
    constexpr int kFew = 12;
    std::uint64_t pairs = (voxels | voxels >> 8) & 0x00FF00FF00FF00FF;
    if (std::popcount(pairs) >= kFew) {
        for (int u = 0; u < 8; u += 2) {
            for (int v = 0; v < 8; ++v) use(u, v);
        }
        return;
    }
    for (; pairs != 0; pairs &= pairs - 1) {
        const int n = std::countr_zero(pairs);
        use(n >> 3, n & 7);
    }
}

void paintColorsKernel(std::uint64_t voxels, const ClassIndex* classes,
                       const ClassTable::Color* colors, std::int16_t* plane, std::size_t pitch) {
    const hn::FixedTag<std::int16_t, 4> half;
    const hn::FixedTag<std::int16_t, 8> tag;
    forPairs(voxels, [&](int u, int v) HWY_ATTR {
        const auto colorAt = [&](int row) HWY_ATTR {
            const ClassTable::Color& color = colors[classes[8 * row + v]];
            return hn::ZeroExtendVector(tag, hn::LoadU(half, color.data()));
        };
        hn::StoreU(hn::InterleaveLower(tag, colorAt(u), colorAt(u + 1)), tag,
                   plane + std::size_t(u / 2) * pitch + 8 * v);
    });
}

void paintOpacitiesKernel(std::uint64_t voxels, const ClassIndex* classes,
                          const std::int16_t* opacities, std::int16_t* plane, std::size_t pitch) {
    forPairs(voxels, [&](int u, int v) {
        const std::int32_t both =
            opacities[classes[8 * u + v]] | std::int32_t{opacities[classes[8 * (u + 1) + v]]} << 16;
        std::memcpy(plane + std::size_t(u / 2) * pitch + 2 * v, &both, sizeof both);
    });
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(paintColorsKernel);
HWY_EXPORT(paintOpacitiesKernel);

void paintPairs(std::uint64_t voxels, const ClassIndex* classes, const ClassTable::Color* colors,
                std::int16_t* plane, std::size_t pitch) {
    HWY_DYNAMIC_DISPATCH(paintColorsKernel)(voxels, classes, colors, plane, pitch);
}

void paintPairs(std::uint64_t voxels, const ClassIndex* classes, const std::int16_t* opacities,
                std::int16_t* plane, std::size_t pitch) {
    HWY_DYNAMIC_DISPATCH(paintOpacitiesKernel)(voxels, classes, opacities, plane, pitch);
}

}  // namespace deltasplat
#endif
