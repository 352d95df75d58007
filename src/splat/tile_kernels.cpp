// SPDX-License-Identifier: Apache-2.0
// Splats 8x8 voxels at a time, compiled once for each SIMD level. Integer arithmetic throughout, so
// that every level gives the same bits.
#include "splat/tile_kernels.h"

#include <bit>

#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splat/tile_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <int kChannels>
class TileSplatter {
    static constexpr int kRow = kTilePixels * kChannels;
    // Vectors never reach over a row's end.
    using Tag = hn::CappedTag < std::int32_t, kRow<16 ? kRow : 16>;
    using V = hn::Vec<Tag>;
    // A pixel more on either side, in whole vectors.
    static constexpr int kPairs = (kRow + 2 * kChannels + 15) / 16 * 16;

  public:
    explicit TileSplatter(const TileWeights& weights) {
        for (int x = 0; x < 3; ++x) {
            first_[x] = hn::Set(Tag(), weights.firstRows[x]);
            last_[x] = hn::Set(Tag(), weights.lastRow[x]);
        }
    }

    // Makes rows [first, last] of a tile and returns which of them are not all zero. Inlined, so
    // that the loops unroll where all rows are asked for.
    HWY_INLINE unsigned run(const std::int16_t* plane, std::size_t planePitch,
                            std::int32_t* HWY_RESTRICT sheet, std::size_t sheetPitch, int first,
                            int last) const {
        const Tag tag;
        HWY_ALIGN std::int32_t pairs[kTilePixels + 2][kPairs];
        pairRows(plane + (first - 1) * std::ptrdiff_t(planePitch) - kChannels, planePitch,
                 last - first + 3, pairs);
        unsigned full = 0;
        sheet += first * sheetPitch;
        for (int y = first; y <= last; ++y, sheet += sheetPitch) {
            V any = hn::Zero(tag);
            for (int i = 0; i < kRow; i += int(hn::Lanes(tag))) {
                V sum = hn::Zero(tag);
                for (int x = 0; x < 3; ++x) {
                    const std::int32_t* firstRows = &pairs[y - first][i + kChannels * x];
                    const std::int32_t* lastRow = &pairs[y - first + 2][i + kChannels * x];
                    sum = addPairs(sum, hn::LoadU(tag, firstRows), first_[x]);
                    sum = addPairs(sum, hn::LoadU(tag, lastRow), last_[x]);
                }
                hn::StoreU(sum, tag, sheet + i);
                any = hn::Or(any, sum);
            }
            full |= unsigned{!hn::AllTrue(tag, hn::Eq(any, hn::Zero(tag)))} << y;
        }
        return full;
    }

  private:
    // Adds the products of the two 16-bit halves of each lane.
    static HWY_INLINE V addPairs(V sum, V colors, V weights) {
        const Tag tag;
        const hn::Repartition<std::int16_t, Tag> half;
        V odd = hn::Zero(tag);
        sum = hn::ReorderWidenMulAccumulate(tag, hn::BitCast(half, colors),
                                            hn::BitCast(half, weights), sum, odd);
        return hn::RearrangeToOddPlusEven(sum, odd);
    }

    // Puts each row of colours into the low halves and the row behind it into the high halves.
    static HWY_INLINE void pairRows(const std::int16_t* plane, std::size_t pitch, int rows,
                                    std::int32_t (*HWY_RESTRICT pairs)[kPairs]) {
        const Tag tag;
        const hn::Rebind<std::int16_t, Tag> narrow;
        const auto load = [&](const std::int16_t* colors) {
            return hn::PromoteTo(tag, hn::LoadU(narrow, colors));
        };
        const V low = hn::Set(tag, 0xFFFF);
        for (int i = 0; i < kPairs; i += int(hn::Lanes(tag))) {
            V row = load(plane + i);
            for (int y = 0; y < rows; ++y) {
                const V behind = load(plane + (y + 1) * pitch + i);
                hn::Store(hn::Or(hn::And(row, low), hn::ShiftLeft<16>(behind)), tag, &pairs[y][i]);
                row = behind;
            }
        }
    }

    V first_[3];
    V last_[3];
};

template <int kChannels>
void splatTilesOf(const TileWeights& weights, const TileRow& row,
                  std::span<const std::uint8_t> touched, std::span<std::uint8_t> full) {
    const TileSplatter<kChannels> splatter(weights);
    for (std::size_t i = 0; i < touched.size(); ++i) {
        const unsigned rows = touched[i];
        if (rows == 0) continue;
        const std::size_t column = std::size_t{kTilePixels} * kChannels * i;
        const auto run = [&](int first, int last) HWY_ATTR {
            return splatter.run(row.plane + column, row.planePitch, row.sheet + column,
                                row.sheetPitch, first, last);
        };
        const unsigned found = rows == 0xFF ? run(0, kTilePixels - 1)
                                            : run(std::countr_zero(rows), std::bit_width(rows) - 1);
        full[i] = std::uint8_t((full[i] & ~rows) | found);
    }
}

void splatTilesKernel(const TileWeights& weights, const TileRow& row,
                      std::span<const std::uint8_t> touched, std::span<std::uint8_t> full) {
    return weights.channels == 4 ? splatTilesOf<4>(weights, row, touched, full)
                                 : splatTilesOf<1>(weights, row, touched, full);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(splatTilesKernel);

TileWeights::TileWeights(const Footprint& footprint, int sheetChannels) : channels(sheetChannels) {
    const auto weightAt = [&](int x, int y) {
        const int reach = footprint.reach();
        // What a voxel gives to the pixel before it, the pixel takes from the voxel behind it.
        const int column = reach - x;
        const int row = reach - y;
        const bool inside =
            column >= 0 && row >= 0 && column < footprint.width && row < footprint.width;
        return inside ? footprint.at(column, row) : 0;
    };
    for (int x = -1; x <= 1; ++x) {
        firstRows[x + 1] = weightAt(x, 0) << 16 | weightAt(x, -1);
        lastRow[x + 1] = weightAt(x, 1);
    }
}

void splatTiles(const TileWeights& weights, const TileRow& row,
                std::span<const std::uint8_t> touched, std::span<std::uint8_t> full) {
    HWY_DYNAMIC_DISPATCH(splatTilesKernel)(weights, row, touched, full);
}

}  // namespace deltasplat
#endif
