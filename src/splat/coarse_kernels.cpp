// SPDX-License-Identifier: Apache-2.0
// Sums sheets whose pixels voxels share, compiled once for each SIMD level. Integer arithmetic
// throughout, so that every level gives the same bits.
// Based on: Lee Westover, "Footprint Evaluation for Volume Rendering", 1990. Deviates in that
// pixels take from voxels what voxels would stamp, and in the kernel, a tent.
#include "splat/coarse_kernels.h"

#include <bit>

#include "simd_targets.h"
#include "splat/tile_bytes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splat/coarse_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "splat/pair_products-inl.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <int kChannels, int kVoxels>
class CoarseSums {
    // Voxels that a pixel takes along an axis; the first lies half a cell before its own.
    static constexpr int kTaps = 2 * kVoxels;
    // The weights 1, 3 .. kTaps - 1 .. 3, 1 of rows and columns add up to 4 kVoxels^4, of which
    // this makes Footprint::one().
    static constexpr int kShift = kVoxels == 2 ? 9 : kVoxels == 4 ? 5 : 1;
    static_assert(4 * kVoxels * kVoxels * kVoxels * kVoxels << kShift == 32768);

    // Of four channels a vector is of several voxels, of one its halves would be of voxels that lie
    // apart.
    static constexpr int kMostLanes = kChannels == 4 ? 16 : 4;
    using Tag = hn::CappedTag<std::int32_t, kMostLanes>;
    using Half = hn::Repartition<std::int16_t, Tag>;
    using V = hn::Vec<Tag>;
    // Half of what a row of a tile takes, in whole vectors, and what these may reach beyond.
    static constexpr int kColumns =
        ((kTilePixels + 1) * kVoxels * kChannels / 2 + 15) / 16 * 16 + 16;

  public:
    // Sums over columns of voxels, in two halves: of four channels every other voxel's, of one
    // every other four voxels'.
    struct Columns {
        HWY_ALIGN std::int32_t even[kColumns];
        HWY_ALIGN std::int32_t odd[kColumns];
    };

    // Adds up the rows of voxels that a row of pixels takes.
    static HWY_INLINE void sumRows(const std::int16_t* HWY_RESTRICT voxels, std::size_t pitch,
                                   Columns& columns) {
        const Tag tag;
        const Half half;
        const int lanes = int(hn::Lanes(tag));
        for (int i = 0; 2 * i < (kTilePixels + 1) * kVoxels * kChannels; i += lanes) {
            V even = hn::Zero(tag);
            V odd = hn::Zero(tag);
            for (int k = 0; k < kTaps; k += 2) {
                const auto row = hn::LoadU(half, voxels + k * pitch + 2 * i);
                const auto behind = hn::LoadU(half, voxels + (k + 1) * pitch + 2 * i);
                const V weights = hn::Set(tag, weightOf(k + 1) << 16 | weightOf(k));
                even = addPairs(even, hn::InterleaveLower(half, row, behind), weights);
                odd = addPairs(odd, hn::InterleaveUpper(half, row, behind), weights);
            }
            hn::Store(even, tag, columns.even + i);
            hn::Store(odd, tag, columns.odd + i);
        }
    }

    // Makes a row of pixels of their sums. Returns whether any is not zero.
    static HWY_INLINE bool makeRow(const Columns& columns, std::int32_t* HWY_RESTRICT sheet) {
        if constexpr (kChannels == 1) {
            std::int32_t any = 0;
            for (int x = 0; x < kTilePixels; ++x) {
                std::int32_t sum = 0;
                for (int k = 0; k < kTaps; ++k) {
                    const int voxel = kVoxels * x + k;
                    const std::int32_t* const of = voxel & 4 ? columns.odd : columns.even;
                    sum += weightOf(k) * of[(voxel >> 3 << 2) + (voxel & 3)];
                }
                sheet[x] = sum << kShift;
                any |= sum;
            }
            return any != 0;
        } else if constexpr (kVoxels == 2) {
            const Tag tag;
            V any = hn::Zero(tag);
            for (int i = 0; i < 4 * kTilePixels; i += int(hn::Lanes(tag))) {
                const V outer =
                    hn::Add(hn::Load(tag, columns.even + i), hn::LoadU(tag, columns.odd + i + 4));
                const V inner =
                    hn::Add(hn::Load(tag, columns.odd + i), hn::LoadU(tag, columns.even + i + 4));
                const V sum = hn::Add(hn::Add(outer, inner), hn::Add(inner, inner));
                const V pixel = hn::ShiftLeft<kShift>(sum);
                hn::StoreU(pixel, tag, sheet + i);
                any = hn::Or(any, pixel);
            }
            return !hn::AllTrue(tag, hn::Eq(any, hn::Zero(tag)));
        } else {
            const hn::FixedTag<std::int32_t, 4> tag;
            auto any = hn::Zero(tag);
            for (int x = 0; x < kTilePixels; ++x) {
                const int first = 4 * kVoxels / 2 * x;
                auto sum = hn::Zero(tag);
                for (int k = 0; k < kVoxels; k += 2) {
                    // Voxels k and kTaps - 1 - k have the same weight.
                    const int last = first + 2 * (kTaps - 2 - k);
                    const auto outer = hn::Add(hn::Load(tag, columns.even + first + 2 * k),
                                               hn::Load(tag, columns.odd + last));
                    const auto inner = hn::Add(hn::Load(tag, columns.odd + first + 2 * k),
                                               hn::Load(tag, columns.even + last));
                    sum = hn::Add(sum, hn::Mul(outer, hn::Set(tag, weightOf(k))));
                    sum = hn::Add(sum, hn::Mul(inner, hn::Set(tag, weightOf(k + 1))));
                }
                sum = hn::ShiftLeft<kShift>(sum);
                hn::StoreU(sum, tag, sheet + 4 * x);
                any = hn::Or(any, sum);
            }
            return !hn::AllTrue(tag, hn::Eq(any, hn::Zero(tag)));
        }
    }

  private:
    static constexpr std::int32_t weightOf(int tap) {
        return 2 * (tap < kVoxels ? tap : kTaps - 1 - tap) + 1;
    }

    template <class H>
    static HWY_INLINE V addPairs(V sum, H pairs, V weights) {
        const Tag tag;
        return hn::Add(sum, productsOfPairs(tag, hn::BitCast(tag, pairs), weights));
    }
};

template <int kChannels, int kVoxels>
void splatCoarseOf(const PlaneRow& plane, const TileRow& row, std::span<const std::uint8_t> touched,
                   std::span<std::uint8_t> full) {
    using Sums = CoarseSums<kChannels, kVoxels>;
    typename Sums::Columns columns;
    constexpr int kBefore = kVoxels / 2;
    const std::int16_t* first = plane.first - kBefore * (std::ptrdiff_t(plane.pitch) + kChannels);
    forTiles(touched, [&](std::size_t i) HWY_ATTR {
        const unsigned rows = touched[i];
        const std::size_t column = std::size_t{kTilePixels} * kChannels * i;
        unsigned found = 0;
        for (int y = std::countr_zero(rows); rows >> y != 0; ++y) {
            Sums::sumRows(first + kVoxels * (y * plane.pitch + column), plane.pitch, columns);
            const bool any = Sums::makeRow(columns, row.sheet + y * row.sheetPitch + column);
            found |= unsigned{any} << y;
        }
        full[i] = std::uint8_t((full[i] & ~rows) | (found & rows));
    });
}

template <int kChannels>
void splatCoarseBy(int voxelsPerPixel, const PlaneRow& plane, const TileRow& row,
                   std::span<const std::uint8_t> touched, std::span<std::uint8_t> full) {
    if (voxelsPerPixel == 2) return splatCoarseOf<kChannels, 2>(plane, row, touched, full);
    if (voxelsPerPixel == 4) return splatCoarseOf<kChannels, 4>(plane, row, touched, full);
    splatCoarseOf<kChannels, 8>(plane, row, touched, full);
}

void splatCoarseKernel(const CoarseWeights& weights, const PlaneRow& plane, const TileRow& row,
                       std::span<const std::uint8_t> touched, std::span<std::uint8_t> full) {
    if (weights.channels == 4)
        return splatCoarseBy<4>(weights.voxelsPerPixel, plane, row, touched, full);
    splatCoarseBy<1>(weights.voxelsPerPixel, plane, row, touched, full);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(splatCoarseKernel);

void splatCoarse(const CoarseWeights& weights, const PlaneRow& plane, const TileRow& row,
                 std::span<const std::uint8_t> touched, std::span<std::uint8_t> full) {
    HWY_DYNAMIC_DISPATCH(splatCoarseKernel)(weights, plane, row, touched, full);
}

}  // namespace deltasplat
#endif
