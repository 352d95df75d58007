// SPDX-License-Identifier: Apache-2.0
// Splats 8x8 voxels at a time, compiled once for each SIMD level. Integer arithmetic throughout, so
// that every level gives the same bits.
#include "splat/tile_kernels.h"

#include <bit>

#include "deltasplat/optics/class_table.h"
#include "simd_targets.h"
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
    // From one voxel to the next along a row.
    static constexpr int kStep = kResolution * kChannels;
    // A voxel more on either side, in whole vectors.
    static constexpr int kPairs = (kRow + 2 * kStep + 15) / 16 * 16;

  public:
    explicit TileSums(const TileWeights& weights) {
        load(weights.firstRows, firstRows_);
        load(weights.lastRow, lastRow_);
        load(weights.between, between_);
    }

    using PairRow = std::int32_t[kPairs];
    // Rows of pairs for one tile: from the one before the first voxel's.
    using Pairs = PairRow[kTilePixels + 2];

    // Pairs up the rows of voxels that rows [first, last] of a tile take. Inlined, so that the
    // loops unroll where all rows are asked for.
    static HWY_INLINE void pairUp(const std::int16_t* plane, std::size_t planePitch, int first,
                                  int last, Pairs& pairs) {
        const int firstVoxel = first / kResolution;
        const int rows = last / kResolution - firstVoxel + 3;
        const std::int16_t* voxels = plane + (firstVoxel - 1) * std::ptrdiff_t(planePitch);
        if constexpr (kResolution == 1) {
            pairRows(voxels - kChannels, planePitch, rows, pairs);
        } else {
            pairDoubledRows(voxels - kChannels, planePitch, rows, pairs);
        }
    }

    // Makes rows [first, last] of a tile and returns which of them are not all zero.
    HWY_INLINE unsigned makeRows(const Pairs& pairs, std::int32_t* HWY_RESTRICT sheet,
                                 std::size_t sheetPitch, int first, int last) const {
        const int firstVoxel = first / kResolution;
        unsigned full = 0;
        sheet += first * sheetPitch;
        for (int y = first; y <= last; ++y, sheet += sheetPitch) {
            const bool any =
                makeRow(pairs + (y / kResolution - firstVoxel), y % kResolution != 0, sheet);
            full |= unsigned{any} << y;
        }
        return full;
    }

    // Adds low digits to some rows of a tile that hold high ones.
    // @param pairs  of low digits, from those of the first of the rows on
    // @return of these rows, those in which any low digit is other than zero
    HWY_INLINE unsigned addLowRows(const Pairs& pairs, std::int32_t* HWY_RESTRICT sheet,
                                   std::size_t sheetPitch, unsigned rows, unsigned& full) const {
        const int firstVoxel = std::countr_zero(rows) / kResolution;
        unsigned low = 0;
        for (unsigned rest = rows; rest != 0; rest &= rest - 1) {
            const int y = std::countr_zero(rest);
            bool isFull = false;
            const bool any = addLowRow(pairs + (y / kResolution - firstVoxel), y % kResolution != 0,
                                       sheet + y * sheetPitch, isFull);
            low |= unsigned{any} << y;
            full |= unsigned{isFull} << y;
        }
        return low;
    }

  private:
    // Makes one row of pixels; `pairs` begins with the pair before the voxels' row.
    HWY_INLINE bool makeRow(const PairRow* pairs, bool between,
                            std::int32_t* HWY_RESTRICT sheet) const {
        const Tag tag;
        V any = hn::Zero(tag);
        for (int i = 0; i < kRow; i += int(hn::Lanes(tag))) {
            const V sum = sumAt(pairs, between, i);
            hn::StoreU(sum, tag, sheet + i);
            any = hn::Or(any, sum);
        }
        return isAny(any);
    }

    // The same of low digits, which are added to what is there.
    HWY_INLINE bool addLowRow(const PairRow* pairs, bool between, std::int32_t* HWY_RESTRICT sheet,
                              bool& isFull) const {
        const Tag tag;
        const V half = hn::Set(tag, 1 << (ClassTable::kDigitBits - 1));
        V any = hn::Zero(tag);
        V anyLow = hn::Zero(tag);
        for (int i = 0; i < kRow; i += int(hn::Lanes(tag))) {
            const V low = sumAt(pairs, between, i);
            const V sum = hn::Add(hn::LoadU(tag, sheet + i),
                                  hn::ShiftRight<ClassTable::kDigitBits>(hn::Add(low, half)));
            hn::StoreU(sum, tag, sheet + i);
            any = hn::Or(any, sum);
            anyLow = hn::Or(anyLow, low);
        }
        isFull = isAny(any);
        return isAny(anyLow);
    }

    static HWY_INLINE bool isAny(V lanes) {
        return !hn::AllTrue(Tag(), hn::Eq(lanes, hn::Zero(Tag())));
    }

    // Sums up a vector of a row's pixels.
    HWY_INLINE V sumAt(const PairRow* pairs, bool between, int i) const {
        const Tag tag;
        const int phase = i / int(hn::Lanes(tag)) % kPhases;
        V sum = hn::Zero(tag);
        for (int x = 0; x < 3; ++x) {
            const int place = i + kStep * x;
            if (between) {
                sum = addPairs(sum, pairs[1] + place, between_[phase][x]);
            } else {
                sum = addPairs(sum, pairs[0] + place, firstRows_[phase][x]);
                sum = addPairs(sum, pairs[2] + place, lastRow_[phase][x]);
            }
        }
        return sum;
    }

    static HWY_INLINE V addPairs(V sum, const std::int32_t* colors, V weights) {
        const Tag tag;
        return hn::Add(sum, productsOfPairs(tag, hn::LoadU(tag, colors), weights));
    }

    template <class T>
    static HWY_INLINE hn::Vec<T> loadColors(T tag, const std::int16_t* colors) {
        return hn::PromoteTo(tag, hn::LoadU(hn::Rebind<std::int16_t, T>(), colors));
    }
    template <class T>
    static HWY_INLINE hn::Vec<T> paired(T tag, hn::Vec<T> row, hn::Vec<T> behind) {
        return hn::Or(hn::And(row, hn::Set(tag, 0xFFFF)), hn::ShiftLeft<16>(behind));
    }

    // Puts each row of colours into the low halves and the row behind it into the high halves.
    static HWY_INLINE void pairRows(const std::int16_t* plane, std::size_t pitch, int rows,
                                    PairRow* HWY_RESTRICT pairs) {
        const Tag tag;
        for (int i = 0; i < kPairs; i += int(hn::Lanes(tag))) {
            V row = loadColors(tag, plane + i);
            for (int y = 0; y < rows; ++y) {
                const V behind = loadColors(tag, plane + (y + 1) * pitch + i);
                hn::Store(paired(tag, row, behind), tag, &pairs[y][i]);
                row = behind;
            }
        }
    }

    // Likewise, each voxel twice.
    static HWY_INLINE void pairDoubledRows(const std::int16_t* plane, std::size_t pitch, int rows,
                                           PairRow* HWY_RESTRICT pairs) {
        const hn::FixedTag<std::int32_t, kChannels> tag;
        for (int i = 0; i < kRow / kResolution + 2 * kChannels; i += kChannels) {
            auto row = loadColors(tag, plane + i);
            for (int y = 0; y < rows; ++y) {
                const auto behind = loadColors(tag, plane + (y + 1) * pitch + i);
                const auto pair = paired(tag, row, behind);
                hn::StoreU(pair, tag, &pairs[y][2 * i]);
                hn::StoreU(pair, tag, &pairs[y][2 * i + kChannels]);
                row = behind;
            }
        }
    }

    // A vector may be shorter than a step: then weights differ from one to the next.
    static constexpr int kLanes = int(hn::MaxLanes(Tag()));
    static constexpr int kPhases = kStep > kLanes ? kStep / kLanes : 1;
    using Weights = V[kPhases][3];

    static void load(const TileWeights::Columns& columns, Weights& weights) {
        for (int phase = 0; phase < kPhases; ++phase) {
            for (int x = 0; x < 3; ++x)
                weights[phase][x] = hn::LoadU(Tag(), &columns[x][phase * kLanes]);
        }
    }

    Weights firstRows_;
    Weights lastRow_;
    Weights between_;
};

template <int kChannels, int kResolution>
void splatTilesOf(const TileWeights& weights, const PlaneRow& plane, const LowRow& low,
                  const TileRow& row, std::span<const std::uint8_t> touched,
                  std::span<std::uint8_t> full) {
    using Sums = TileSums<kChannels, kResolution>;
    const Sums sums(weights);
    // Two tiles are in work: rows are made while the pairs of the next tile are on their way to the
    // cache, for they are read otherwise than they were written.
    HWY_ALIGN typename Sums::Pairs pairs[2];
    HWY_ALIGN typename Sums::Pairs lowPairs[2];
    unsigned lowRows[2] = {};
    const auto columnOf = [](std::size_t i) { return std::size_t{kTilePixels} * kChannels * i; };
    const auto pairUp = [&](std::size_t i, const PlaneRow& from, unsigned rows,
                            typename Sums::Pairs& out) HWY_ATTR {
        forRows(rows, [&](int first, int last) HWY_ATTR {
            Sums::pairUp(from.first + columnOf(i) / kResolution, from.pitch, first, last, out);
        });
    };
    const auto finish = [&](std::size_t i, int buffer) HWY_ATTR {
        const unsigned rows = touched[i];
        std::int32_t* sheet = row.sheet + columnOf(i);
        const unsigned found = forRows(rows, [&](int first, int last) HWY_ATTR {
            return sums.makeRows(pairs[buffer], sheet, row.sheetPitch, first, last);
        });
        unsigned now = (full[i] & ~rows) | (found & rows);
        if (const unsigned ofLow = lowRows[buffer]; ofLow != 0) {
            const unsigned any =
                sums.addLowRows(lowPairs[buffer], sheet, row.sheetPitch, ofLow, now);
            low.rows[i] = std::uint8_t((low.rows[i] & ~ofLow) | any);
        }
        full[i] = std::uint8_t(now);
    };
    std::size_t before = touched.size();
    int buffer = 0;
    forTiles(touched, [&](std::size_t i) HWY_ATTR {
        pairUp(i, plane, touched[i], pairs[buffer]);
        if (!low.rows.empty()) {
            lowRows[buffer] = rowsMade(touched[i]) & low.rows[i];
            if (lowRows[buffer] != 0) pairUp(i, low.plane, lowRows[buffer], lowPairs[buffer]);
        }
        buffer ^= 1;
        if (before < touched.size()) finish(before, buffer);
        before = i;
    });
    if (before < touched.size()) finish(before, buffer ^ 1);
}

void splatTilesKernel(const TileWeights& weights, const PlaneRow& plane, const LowRow& low,
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
            // Whether a row is full is hard to foretell: looking at all of it is faster than
            // stopping.
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
    return footprint.resolution <= 2 && footprint.voxelsPerPixel == 1 && footprint.width % 2 == 1 &&
           footprint.width <= 2 * footprint.resolution + 1;
}

TileWeights::TileWeights(const Footprint& footprint, int sheetChannels)
    : resolution(footprint.resolution), channels(sheetChannels) {
    // What a voxel gives to the pixel at (x, y) from it.
    const auto weightAt = [&](int x, int y) {
        const int column = x + footprint.reach();
        const int row = y + footprint.reach();
        const bool inside =
            column >= 0 && row >= 0 && column < footprint.width && row < footprint.width;
        return inside ? footprint.at(column, row) : 0;
    };
    for (int column = 0; column < 3; ++column) {
        for (int lane = 0; lane < 16; ++lane) {
            // The pixel's place behind a voxel, and behind the voxel of this column.
            const int phase = lane / channels % resolution;
            const int x = phase - resolution * (column - 1);
            const auto pair = [&](int y, int yBehind) {
                return std::int32_t(weightAt(x, yBehind) << 16 | weightAt(x, y));
            };
            firstRows[column][lane] = pair(resolution, 0);
            lastRow[column][lane] = weightAt(x, -resolution);
            if (resolution == 2) between[column][lane] = pair(1, -1);
        }
    }
}

void splatTiles(const TileWeights& weights, const PlaneRow& plane, const LowRow& low,
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
