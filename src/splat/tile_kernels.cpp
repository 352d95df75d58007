// SPDX-License-Identifier: Apache-2.0
// Splats 8x8 voxels at a time, compiled once per SIMD level. Integer arithmetic gives the same bits
// at every level.
#include "splat/tile_kernels.h"

#include <bit>
#include <type_traits>
#include <utility>

#include "base/simd_targets.h"
#include "deltasplat/optics/class_table.h"
#include "splat/tile_bytes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splat/tile_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "splat/pair_products-inl.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <int kChannels, int kResolution>
class TileSums {
    static constexpr int kRow = kTilePixels * kChannels;
    // Vectors never reach over a row's end.
    using Tag = hn::CappedTag < std::int32_t, kRow<16 ? kRow : 16>;
    using V = hn::Vec<Tag>;
    static constexpr int kLanes = int(hn::MaxLanes(Tag()));
    // Rows of pixels per pair of rows of voxels.
    static constexpr int kPairRows = 2 * kResolution;

  public:
    explicit TileSums(const TileWeights& weights)
        : TileSums(weights, std::make_integer_sequence<int, kPhases>()) {}

    // Makes rows of a tile and returns which are not all zero.
    template <bool kIsAll>
    HWY_INLINE unsigned makeRows(const PairedRow& tile, std::int32_t* HWY_RESTRICT sheet,
                                 std::size_t sheetPitch, unsigned rows) const {
        Made made{0, 0};
        sumRows<kIsAll, false>(tile, sheet, sheetPitch, rows, made);
        return made.full;
    }

    // Adds low digits to rows of a tile that hold high ones.
    // @param full  bits are set for rows that are not all zero now
    // @return the rows with any low digit other than zero
    template <bool kIsAll>
    HWY_INLINE unsigned addLowRows(const PairedRow& tile, std::int32_t* HWY_RESTRICT sheet,
                                   std::size_t sheetPitch, unsigned rows, unsigned& full) const {
        Made made{full, 0};
        sumRows<kIsAll, true>(tile, sheet, sheetPitch, rows, made);
        full = made.full;
        return made.low;
    }

  private:
    // A compiler-made constructor would have no SIMD level, so vectors are made from values.
    template <int... kPhase>
    TileSums(const TileWeights& weights, std::integer_sequence<int, kPhase...>)
        : weights_{weightsOf(weights, kPhase)...} {}

    // Voxels of a vector of pixels in a pair of rows, and their neighbours.
    struct Columns {
        V before, here, behind;
    };
    // In a vector shorter than a voxel's pixels, weights differ from one vector to the next.
    static constexpr int kStep = kResolution * kChannels;
    static constexpr int kPhases = kStep > kLanes ? kStep / kLanes : 1;
    // Weights other than zero for rows 0 to 3 of a pair, named to stay in registers.
    struct Weights {
        Columns before0, here0, here1, here2, here3, behind1, behind2, behind3;
    };
    // Short vectors outnumber the registers: read where used.
    using KeptWeights = std::conditional_t<(kLanes > 4), const Weights, const Weights&>;

    static HWY_INLINE bool isAny(V lanes) {
        return !hn::AllTrue(Tag(), hn::Eq(lanes, hn::Zero(Tag())));
    }

    // Rows that are not all zero, and rows with low digits.
    struct Made {
        unsigned full, low;
    };

    // Writes numbers of a row from `to` on, or adds them as the low digit.
    template <bool kIsLow>
    static HWY_INLINE void finish(V sum, std::int32_t* HWY_RESTRICT to, int y, Made& made) {
        const Tag tag;
        if constexpr (kIsLow) {
            made.low |= unsigned{isAny(sum)} << y;
            const V half = hn::Set(tag, 1 << (ClassTable::kDigitBits - 1));
            sum = hn::Add(hn::LoadU(tag, to),
                          hn::ShiftRight<ClassTable::kDigitBits>(hn::Add(sum, half)));
        }
        hn::StoreU(sum, tag, to);
        made.full |= unsigned{isAny(sum)} << y;
    }

    template <bool kIsAll, bool kIsLow>
    HWY_INLINE void sumRows(const PairedRow& tile, std::int32_t* HWY_RESTRICT sheet,
                            std::size_t pitch, unsigned rows, Made& made) const {
        constexpr int kPairs = kTilePixels / kPairRows;
        const int firstPair = kIsAll ? 0 : std::countr_zero(rows) / kPairRows;
        const int lastPair = kIsAll ? kPairs - 1 : (int(std::bit_width(rows)) - 1) / kPairRows;
        for (int i = 0; i < kRow; i += kLanes) {
            KeptWeights w = weights_[i / kLanes % kPhases];
            Columns before = columnsAt(tile, firstPair - 1, i);
            Columns here = columnsAt(tile, firstPair, i);
            std::int32_t* to = sheet + kPairRows * firstPair * pitch + i;
#pragma GCC unroll 4
            for (int pair = firstPair; pair <= lastPair; ++pair, to += kPairRows * pitch) {
                const Columns behind = columnsAt(tile, pair + 1, i);
                const int y = kPairRows * pair;
                const unsigned asked = kIsAll ? 0xFF : rows >> y;
                if (asked & 1) finish<kIsLow>(sumOf(before, w.before0, here, w.here0), to, y, made);
                if constexpr (kResolution == 1) {
                    if (asked & 2)
                        finish<kIsLow>(sumOf(here, w.here1, behind, w.behind1), to + pitch, y + 1,
                                       made);
                } else {
                    if (asked & 2) finish<kIsLow>(sumOf(here, w.here1), to + pitch, y + 1, made);
                    if (asked & 4)
                        finish<kIsLow>(sumOf(here, w.here2, behind, w.behind2), to + 2 * pitch,
                                       y + 2, made);
                    if (asked & 8)
                        finish<kIsLow>(sumOf(here, w.here3, behind, w.behind3), to + 3 * pitch,
                                       y + 3, made);
                }
                before = here;
                here = behind;
            }
        }
    }

    static HWY_INLINE void add(const Columns& colors, const Columns& weights, PairSum<Tag>& sum) {
        sum.add(colors.before, weights.before);
        sum.add(colors.here, weights.here);
        sum.add(colors.behind, weights.behind);
    }
    static HWY_INLINE V sumOf(const Columns& colors, const Columns& weights) {
        PairSum<Tag> sum;
        add(colors, weights, sum);
        return sum.total();
    }
    static HWY_INLINE V sumOf(const Columns& a, const Columns& weightsOfA, const Columns& b,
                              const Columns& weightsOfB) {
        PairSum<Tag> sum;
        add(a, weightsOfA, sum);
        add(b, weightsOfB, sum);
        return sum.total();
    }

    static HWY_INLINE Columns columnsAt(const PairedRow& tile, int pair, int i) {
        const std::int16_t* row = tile.first + pair * std::ptrdiff_t(tile.pitch);
        const auto at = [&](int column) HWY_ATTR {
            const int voxel = i / kChannels / kResolution + column;
            const int number = kResolution == 1 ? i + kChannels * column : kChannels * voxel;
            const V loaded = hn::BitCast(
                Tag(), hn::LoadU(hn::Repartition<std::int16_t, Tag>(), row + 2 * number));
            return kResolution == 1 ? loaded : doubled(loaded);
        };
        return {at(-1), at(0), at(1)};
    }

    // Repeats each voxel for its pixels in a row.
    static HWY_INLINE V doubled(V voxels) {
        if constexpr (kLanes <= kChannels) return voxels;
        const Tag tag;
        HWY_ALIGN std::int32_t places[kLanes];
        for (int lane = 0; lane < kLanes; ++lane)
            places[lane] = lane / kChannels / 2 * kChannels + lane % kChannels;
        return hn::TableLookupLanes(voxels, hn::SetTableIndices(tag, places));
    }

    static HWY_INLINE Weights weightsOf(const TileWeights& weights, int phase) {
        const auto load = [&](const TileWeights::Columns& columns) HWY_ATTR {
            const auto at = [&](std::size_t column) HWY_ATTR {
                return hn::LoadU(Tag(), &columns[column][std::size_t(phase) * kLanes]);
            };
            return Columns{at(0), at(1), at(2)};
        };
        const auto& rows = weights.rows;
        return {load(rows[0].before), load(rows[0].here),  load(rows[1].here),
                load(rows[2].here),   load(rows[3].here),  load(rows[1].behind),
                load(rows[2].behind), load(rows[3].behind)};
    }

    Weights weights_[kPhases];
};

template <int kChannels, int kResolution>
void splatTilesOf(const TileWeights& weights, const PairedRow& plane, const LowRow& low,
                  const TileRow& row, std::span<const std::uint8_t> touched,
                  std::span<std::uint8_t> full) {
    const TileSums<kChannels, kResolution> sums(weights);
    constexpr std::size_t kColumn = std::size_t{kTilePixels} * kChannels;
    constexpr unsigned kAll = 0xFF;
    const auto tileOf = [](const PairedRow& of, std::size_t i) {
        return PairedRow{of.first + 2 * kColumn / kResolution * i, of.pitch};
    };
    forTiles(touched, [&](std::size_t i) HWY_ATTR {
        const unsigned rows = touched[i];
        std::int32_t* sheet = row.sheet + kColumn * i;
        const PairedRow tile = tileOf(plane, i);
        const unsigned found =
            rows == kAll ? sums.template makeRows<true>(tile, sheet, row.sheetPitch, kAll)
                         : sums.template makeRows<false>(tile, sheet, row.sheetPitch, rows);
        unsigned now = (full[i] & ~rows) | found;
        const unsigned lowRows = low.rows.empty() ? 0 : rows & low.rows[i];
        if (lowRows != 0) {
            const PairedRow lowTile = tileOf(low.plane, i);
            const unsigned any =
                lowRows == kAll
                    ? sums.template addLowRows<true>(lowTile, sheet, row.sheetPitch, kAll, now)
                    : sums.template addLowRows<false>(lowTile, sheet, row.sheetPitch, lowRows, now);
            low.rows[i] = std::uint8_t((low.rows[i] & ~lowRows) | any);
        }
        full[i] = std::uint8_t(now);
    });
}

void splatTilesKernel(const TileWeights& weights, const PairedRow& plane, const LowRow& low,
                      const TileRow& row, std::span<const std::uint8_t> touched,
                      std::span<std::uint8_t> full) {
    if (weights.resolution == 1) {
        return weights.channels == 4 ? splatTilesOf<4, 1>(weights, plane, low, row, touched, full)
                                     : splatTilesOf<1, 1>(weights, plane, low, row, touched, full);
    }
    return weights.channels == 4 ? splatTilesOf<4, 2>(weights, plane, low, row, touched, full)
                                 : splatTilesOf<1, 2>(weights, plane, low, row, touched, full);
}

void findFullRowsKernel(const TileRow& row, int channels, std::span<const std::uint8_t> touched,
                        std::span<std::uint8_t> full) {
    const hn::CappedTag<std::int32_t, 8> tag;
    const std::size_t length = std::size_t{kTilePixels} * channels;
    forTiles(touched, [&](std::size_t i) HWY_ATTR {
        const std::int32_t* tile = row.sheet + length * i;
        unsigned found = 0;
        for (unsigned rest = touched[i]; rest != 0; rest &= rest - 1) {
            const int y = std::countr_zero(rest);
            // Fullness is hard to predict: scanning a whole row is faster than stopping early.
            auto any = hn::Zero(tag);
            for (std::size_t x = 0; x < length; x += hn::Lanes(tag))
                any = hn::Or(any, hn::LoadU(tag, tile + y * row.sheetPitch + x));
            found |= unsigned{!hn::AllTrue(tag, hn::Eq(any, hn::Zero(tag)))} << y;
        }
        full[i] = std::uint8_t((full[i] & ~touched[i]) | found);
    });
}

void addLowDigitsKernel(const DigitRows& digits, int channels, std::span<const std::uint8_t> rows,
                        std::int32_t* sheet, std::span<std::uint8_t> full) {
    const hn::CappedTag<std::int32_t, 8> tag;
    const std::size_t length = std::size_t{kTilePixels} * channels;
    const auto half = hn::Set(tag, 1 << (ClassTable::kDigitBits - 1));
    forTiles(rows, [&](std::size_t i) HWY_ATTR {
        for (unsigned rest = rows[i]; rest != 0; rest &= rest - 1) {
            const int y = std::countr_zero(rest);
            const std::size_t first = length * i + std::size_t(y) * digits.pitch;
            auto any = hn::Zero(tag);
            for (std::size_t x = first; x < first + length; x += hn::Lanes(tag)) {
                const auto low = hn::Add(hn::LoadU(tag, digits.low + x), half);
                const auto sum = hn::Add(hn::LoadU(tag, digits.high + x),
                                         hn::ShiftRight<ClassTable::kDigitBits>(low));
                hn::StoreU(sum, tag, sheet + x);
                any = hn::Or(any, sum);
            }
            const bool isFull = !hn::AllTrue(tag, hn::Eq(any, hn::Zero(tag)));
            full[i] = std::uint8_t(full[i] | unsigned{isFull} << y);
        }
    });
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(splatTilesKernel);
HWY_EXPORT(findFullRowsKernel);
HWY_EXPORT(addLowDigitsKernel);

bool TileWeights::fits(const Footprint& footprint) {
    return footprint.resolution <= 2 && footprint.width % 2 == 1 &&
           footprint.width <= 2 * footprint.resolution + 1;
}

TileWeights::TileWeights(const Footprint& footprint, int sheetChannels)
    : resolution(footprint.resolution), channels(sheetChannels) {
    // Weight of a voxel for the pixel at (x, y) from it.
    const auto weightAt = [&](int x, int y) {
        const int column = x + footprint.reach();
        const int row = y + footprint.reach();
        const bool inside =
            column >= 0 && row >= 0 && column < footprint.width && row < footprint.width;
        return inside ? footprint.at(column, row) : 0;
    };
    for (std::size_t column = 0; column < 3; ++column) {
        for (std::size_t lane = 0; lane < 16; ++lane) {
            // The pixel's place behind the voxel of its column.
            const int phase = int(lane) / channels % resolution;
            const int x = phase - resolution * (int(column) - 1);
            // Weights of a pixel for rows of voxels y and yBehind before it.
            const auto pair = [&](int y, int yBehind) {
                return std::int32_t(weightAt(x, yBehind) << 16 | weightAt(x, y));
            };
            constexpr int kNone = 1 << 10;
            const int r = resolution;
            for (int row = 0; row < 2 * r; ++row) {
                // The pair's rows of voxels lie at 0 and r.
                Row& weights = rows[std::size_t(row)];
                weights.before[column][lane] = pair(kNone, row + r);
                weights.here[column][lane] = pair(row, row - r);
                weights.behind[column][lane] = pair(row - 2 * r, kNone);
            }
        }
    }
}

void splatTiles(const TileWeights& weights, const PairedRow& plane, const LowRow& low,
                const TileRow& row, std::span<const std::uint8_t> touched,
                std::span<std::uint8_t> full) {
    HWY_DYNAMIC_DISPATCH(splatTilesKernel)(weights, plane, low, row, touched, full);
}

void addLowDigits(const DigitRows& digits, int channels, std::span<const std::uint8_t> rows,
                  std::int32_t* sheet, std::span<std::uint8_t> full) {
    HWY_DYNAMIC_DISPATCH(addLowDigitsKernel)(digits, channels, rows, sheet, full);
}

void findFullRows(const TileRow& row, int channels, std::span<const std::uint8_t> touched,
                  std::span<std::uint8_t> full) {
    HWY_DYNAMIC_DISPATCH(findFullRowsKernel)(row, channels, touched, full);
}

}  // namespace deltasplat
#endif
