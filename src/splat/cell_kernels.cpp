// SPDX-License-Identifier: Apache-2.0
// Sums sheets of wide footprints, compiled once per SIMD level. Integer arithmetic gives the same
// bits at every level.
// Based on: Lee Westover, "Footprint Evaluation for Volume Rendering", 1990. Deviates in that
// pixels take from voxels what voxels would stamp: the same integers.
#include "splat/cell_kernels.h"

#include <algorithm>
#include <bit>

#include "base/bits.h"
#include "base/simd_targets.h"
#include "splat/tile_bytes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splat/cell_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "splat/pair_products-inl.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Tiles made at a time, so that their input stays in the first-level cache.
constexpr int kRun = 16;

template <int kChannels, int kResolution, int kTaps>
class CellSums {
    static constexpr int kRow = kTilePixels * kChannels;
    // Vectors never reach over a tile's end.
    using Tag = hn::CappedTag < std::int32_t, kRow<16 ? kRow : 16>;
    using V = hn::Vec<Tag>;
    static constexpr int kBefore = (kTaps - 1) / 2;
    static constexpr int kRowPairs = (kTaps + 1) / 2;
    // From one voxel to the next along a row.
    static constexpr int kStep = kResolution * kChannels;
    // Rows of cells in a tile, and their rows of pairs.
    static constexpr int kMostCells = (kTilePixels - 2) / kResolution + 2;
    static constexpr int kMostPairs = kMostCells + 2 * (kRowPairs - 1);
    // Pixels of a run, of the cells around it, and spare ones for vectors.
    static constexpr int kMostPixels = kRun * kTilePixels + (kTaps + 1) * kResolution + 16;

  public:
    CellSums(const CellWeights& weights, const CellPlane& plane, const TileRow& row)
        : weights_(weights), plane_(plane), row_(row) {
        const int first = floorDiv(plane.pixel.y, kResolution);
        for (int y = 0; y < kTilePixels; ++y) {
            const int cell = floorDiv(plane.pixel.y + y, kResolution);
            cells_[y] = cell - first;
            rowsInCell_[y] = plane.pixel.y + y - cell * kResolution;
        }
        voxels_ = plane.voxel + (first - kBefore) * std::ptrdiff_t(plane.pitch);
    }

    HWY_INLINE void makeRun(int first, int last, std::span<const std::uint8_t> touched,
                            std::span<std::uint8_t> full) {
        unsigned rows = 0;
        for (int i = first; i < last; ++i) rows |= sumsTile(touched[i]) ? 0xFFu : touched[i];
        forRows(rows, [&](int low, int high)
                          HWY_ATTR { pairUp(first, last, cells_[low], cells_[high]); });
        for (int i = first; i < last; ++i) {
            const int pixel = plane_.pixel.x + kTilePixels * i;
            const int x = pixel - kResolution * floorDiv(pixel, kResolution);
            const auto makeRows = [&](int low, int high) HWY_ATTR {
                unsigned any = 0;
                for (int y = low; y <= high; ++y) any |= unsigned{makeRow(i, x, y)} << y;
                return any;
            };
            const unsigned found =
                sumsTile(touched[i]) ? makeTile(i, x, touched[i]) : forRows(touched[i], makeRows);
            full[i] = std::uint8_t((full[i] & ~touched[i]) | (found & touched[i]));
        }
    }

  private:
    // Repeats the pairs of voxels for each pixel of their cells, as far as tiles [first, last) read
    // them for rows of cells [firstCell, lastCell].
    HWY_INLINE void pairUp(int first, int last, int firstCell, int lastCell) {
        const int firstPixel = plane_.pixel.x + kTilePixels * first - kBefore * kResolution;
        const int lastPixel =
            plane_.pixel.x + kTilePixels * last - 1 + (kTaps - 1 - kBefore) * kResolution;
        const int firstVoxel = floorDiv(firstPixel, kResolution);
        const int lastVoxel = floorDiv(lastPixel, kResolution);
        pairsBegin_ = firstVoxel * kResolution - plane_.pixel.x;
        for (int row = firstCell; row <= lastCell + 2 * (kRowPairs - 1); ++row) {
            std::int32_t* out = pairs_[row];
            const std::int16_t* voxel = voxels_ + row * std::ptrdiff_t(plane_.pitch) +
                                        kChannels * std::ptrdiff_t(firstVoxel);
            if constexpr (kResolution == 1) {
                const Tag tag;
                const int length = kChannels * (lastVoxel - firstVoxel + 1);
                for (int i = 0; i < length; i += int(hn::Lanes(tag)))
                    hn::StoreU(pair(tag, voxel + i), tag, out + i);
            } else {
                for (int v = firstVoxel; v <= lastVoxel; ++v, voxel += kChannels, out += kStep)
                    repeat(voxel, out);
            }
        }
    }

    // Returns colours >= 0 in the low halves, and the colours behind them in the high halves.
    template <class T>
    HWY_INLINE hn::Vec<T> pair(T tag, const std::int16_t* voxel) const {
        const hn::Rebind<std::int16_t, T> half;
        const auto here = hn::PromoteTo(tag, hn::LoadU(half, voxel));
        const auto behind = hn::PromoteTo(tag, hn::LoadU(half, voxel + plane_.pitch));
        return hn::Or(here, hn::ShiftLeft<16>(behind));
    }

    // Writes a voxel and the one behind it per pixel of a cell; later calls overwrite the excess.
    HWY_INLINE void repeat(const std::int16_t* voxel, std::int32_t* HWY_RESTRICT out) const {
        if constexpr (kChannels == 4) {
            const hn::FixedTag<std::int32_t, 4> tag;
            const auto both = pair(tag, voxel);
            for (int i = 0; i < kStep; i += 4) hn::StoreU(both, tag, out + i);
        } else {
            const hn::FixedTag<std::int32_t, 4> tag;
            const std::int32_t both = voxel[0] | std::int32_t{voxel[plane_.pitch]} << 16;
            hn::StoreU(hn::Set(tag, both), tag, out);
        }
    }

    // Whether most rows of a tile are made, and the tile begins where makeTile() takes it: anywhere
    // in cells of three pixels, else with a cell, as it does if margins are whole tiles.
    HWY_INLINE bool sumsTile(unsigned touched) const {
        constexpr int kMost = 6;
        // Short registers are few as well, and gain little.
        constexpr bool kIsWorthIt = HWY_MAX_BYTES >= 32;
        return kIsWorthIt && std::popcount(withRowsBetween(touched)) >= kMost &&
               (kResolution == 3 || rowsInCell_[0] == 0);
    }

    // Makes rows of a tile from the x-th pixel of a cell on; returns which are not all zero.
    HWY_INLINE unsigned makeTile(int tile, int x, unsigned touched) const {
        if constexpr (kResolution == 3) {
            if (rowsInCell_[0] == 1) return makeTileFrom<1>(tile, x, touched);
            if (rowsInCell_[0] == 2) return makeTileFrom<2>(tile, x, touched);
        }
        return makeTileFrom<0>(tile, x, touched);
    }

    // Sums up all rows of a tile that begins with row kFirst of a cell, writes touched rows and
    // those between, and returns which are not all zero. Each row of pairs is read once for all
    // rows of pixels. Named sums stay in registers.
    template <int kFirst>
    HWY_INLINE unsigned makeTileFrom(int tile, int x, unsigned touched) const {
        const Tag tag;
        const int first = kChannels * (kTilePixels * tile - kBefore * kResolution - pairsBegin_);
        const unsigned made = withRowsBetween(touched);
        unsigned full = 0;
        for (int i = 0; i < kRow; i += int(hn::Lanes(tag))) {
            const CellWeights::Line* weights[kResolution];
            for (int y = 0; y < kResolution; ++y) weights[y] = weights_.from(x, y);
            V s0 = hn::Zero(tag), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
            addRowsOfPairs<kFirst, 0>(first + i, weights, s0, s1, s2, s3, s4, s5, s6, s7);
            std::int32_t* sheet = row_.sheet + kRow * std::size_t(tile) + i;
            const auto finish = [&](int y, V sum) HWY_ATTR {
                if ((made >> y & 1) == 0) return;
                hn::StoreU(sum, tag, sheet + y * row_.sheetPitch);
                full |= unsigned{!hn::AllTrue(tag, hn::Eq(sum, hn::Zero(tag)))} << y;
            };
            finish(0, s0);
            finish(1, s1);
            finish(2, s2);
            finish(3, s3);
            finish(4, s4);
            finish(5, s5);
            finish(6, s6);
            finish(7, s7);
            x = (x + int(hn::Lanes(tag)) / kChannels) % kResolution;
        }
        return full;
    }

    // Adds the part of rows of pairs from kPairs on to rows of pixels.
    template <int kFirst, int kPairs, class... Sums>
    HWY_INLINE void addRowsOfPairs(int first,
                                   const CellWeights::Line* const (&weights)[kResolution],
                                   Sums&... sums) const {
        constexpr int kLastCell = (kFirst + kTilePixels - 1) / kResolution;
        const std::int32_t* pairs = &pairs_[kPairs][first];
        // Unrolled by GCC, products would be spilled to memory.
#pragma GCC unroll 1
        for (int tap = 0; tap < kTaps; ++tap) {
            const V colors = hn::LoadU(Tag(), pairs + tap * kStep);
            addTo<kPairs, kFirst>(colors, tap, weights, sums...);
        }
        if constexpr (kPairs < kLastCell + 2 * (kRowPairs - 1))
            addRowsOfPairs<kFirst, kPairs + 1>(first, weights, sums...);
    }
    // Adds to the kY-th row from the first cell on, and to the rows behind it.
    template <int kPairs, int kY, class... Sums>
    static HWY_INLINE void addTo(V colors, int tap,
                                 const CellWeights::Line* const (&weights)[kResolution], V& sum,
                                 Sums&... behind) {
        constexpr int kBehind = kPairs - kY / kResolution;
        if constexpr (kBehind >= 0 && kBehind < 2 * kRowPairs && kBehind % 2 == 0) {
            const CellWeights::Line& line = weights[kY % kResolution][kBehind / 2 * kTaps + tap];
            sum = hn::Add(sum, productsOfPairs(Tag(), colors, hn::Load(Tag(), line.data())));
        }
        if constexpr (sizeof...(Sums) > 0) addTo<kPairs, kY + 1>(colors, tap, weights, behind...);
    }

    // Makes row y of a tile from the x-th pixel of a cell on; returns whether it is not all zero.
    HWY_INLINE bool makeRow(int tile, int x, int y) const {
        const Tag tag;
        std::int32_t* sheet = row_.sheet + kRow * std::size_t(tile) + y * row_.sheetPitch;
        const int first = kChannels * (kTilePixels * tile - kBefore * kResolution - pairsBegin_);
        V any = hn::Zero(tag);
        for (int i = 0; i < kRow; i += int(hn::Lanes(tag))) {
            const CellWeights::Line* weights = weights_.from(x, rowsInCell_[y]);
            V sum = hn::Zero(tag);
            for (int rows = 0; rows < kRowPairs; ++rows, weights += kTaps) {
                const std::int32_t* pairs = &pairs_[cells_[y] + 2 * rows][first + i];
                for (int tap = 0; tap < kTaps; ++tap)
                    sum = addPairs(sum, pairs + tap * kStep, weights[tap].data());
            }
            hn::StoreU(sum, tag, sheet + i);
            any = hn::Or(any, sum);
            x = (x + int(hn::Lanes(tag)) / kChannels) % kResolution;
        }
        return !hn::AllTrue(tag, hn::Eq(any, hn::Zero(tag)));
    }

    static HWY_INLINE V addPairs(V sum, const std::int32_t* pairs, const std::int32_t* weights) {
        const Tag tag;
        return hn::Add(sum, productsOfPairs(tag, hn::LoadU(tag, pairs), hn::Load(tag, weights)));
    }

    const CellWeights& weights_;
    const CellPlane& plane_;
    const TileRow& row_;
    int cells_[kTilePixels];       // [row]: row of cells, from the first one on
    int rowsInCell_[kTilePixels];  // [row]: row in that cell
    const std::int16_t* voxels_;   // kBefore rows before the first row of cells
    int pairsBegin_ = 0;           // the first pixel of pairs_, counted from the tiles' first
    // [row]: for every pixel a voxel of a row from voxels_ on, and the one behind it.
    HWY_ALIGN std::int32_t pairs_[kMostPairs][kChannels * kMostPixels];
};

template <int kChannels, int kResolution, int kTaps>
void splatCellsOf(const CellWeights& weights, const CellPlane& plane, const TileRow& row,
                  std::span<const std::uint8_t> touched, std::span<std::uint8_t> full) {
    CellSums<kChannels, kResolution, kTaps> sums(weights, plane, row);
    const int tiles = int(touched.size());
    for (int first = 0; first < tiles;) {
        int last = first;
        while (last < tiles && last - first < kRun && touched[last] != 0) ++last;
        if (last > first) sums.makeRun(first, last, touched, full);
        first = std::max(last, first + 1);
    }
}

template <int kChannels>
void splatCellsBy(const CellWeights& weights, const CellPlane& plane, const TileRow& row,
                  std::span<const std::uint8_t> touched, std::span<std::uint8_t> full) {
    const auto splat = [&]<int kResolution, int kTaps>() {
        splatCellsOf<kChannels, kResolution, kTaps>(weights, plane, row, touched, full);
    };
    const int r = weights.resolution;
    if (r == 1 && weights.taps == 5) return splat.template operator()<1, 5>();
    if (r == 1) return splat.template operator()<1, 7>();
    if (r == 2 && weights.taps == 4) return splat.template operator()<2, 4>();
    if (r == 2 && weights.taps == 5) return splat.template operator()<2, 5>();
    if (r == 2) return splat.template operator()<2, 6>();
    if (r == 3 && weights.taps == 4) return splat.template operator()<3, 4>();
    if (r == 3) return splat.template operator()<3, 6>();
    if (weights.taps == 4) return splat.template operator()<4, 4>();
    splat.template operator()<4, 6>();
}

void splatCellsKernel(const CellWeights& weights, const CellPlane& plane, const TileRow& row,
                      std::span<const std::uint8_t> touched, std::span<std::uint8_t> full) {
    if (weights.channels == 4) return splatCellsBy<4>(weights, plane, row, touched, full);
    splatCellsBy<1>(weights, plane, row, touched, full);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(splatCellsKernel);

namespace {

// Returns the taps of the kernels for a footprint; 0: no kernel.
int tapsOf(const Footprint& footprint) {
    const int r = footprint.resolution;
    // Voxels that reach a cell's first pixel from before, and its last from behind.
    const int before = (footprint.width - 1 - footprint.reach()) / r;
    const int behind = (r - 1 + footprint.reach()) / r;
    if (r > 4 || (r == 1 && footprint.width % 2 == 0)) return 0;
    if (r > 1 && before <= 1 && behind <= 2) return 4;
    if (r <= 2 && before <= 2 && behind <= 2) return 5;
    if (r > 1 && before <= 2 && behind <= 3) return 6;
    return r == 1 && before <= 3 && behind <= 3 ? 7 : 0;
}

}  // namespace

bool CellWeights::fits(const Footprint& footprint) {
    return tapsOf(footprint) != 0;
}

CellWeights::CellWeights(const Footprint& footprint, int sheetChannels)
    : resolution(footprint.resolution), channels(sheetChannels), taps(tapsOf(footprint)) {
    // Weight of a voxel for a pixel of a cell, both counted from the cell.
    const auto weightAt = [&](glm::ivec2 pixel, glm::ivec2 voxel) {
        const glm::ivec2 p = pixel - resolution * voxel + footprint.reach();
        const bool inside = p.x >= 0 && p.y >= 0 && p.x < footprint.width && p.y < footprint.width;
        return inside ? footprint.at(p.x, p.y) : 0;
    };
    for (int n = 0; n < resolution * resolution; ++n) {
        for (int tap = 0; tap < rowPairs() * taps; ++tap) {
            const glm::ivec2 voxel(tap % taps - before(), 2 * (tap / taps) - before());
            Line& line = lines.emplace_back();
            for (int i = 0; i < int(line.size()); ++i) {
                const glm::ivec2 pixel((n + i / channels) % resolution, n / resolution);
                line[i] = weightAt(pixel, voxel) | weightAt(pixel, voxel + glm::ivec2(0, 1)) << 16;
            }
        }
    }
}

void splatCells(const CellWeights& weights, const CellPlane& plane, const TileRow& row,
                std::span<const std::uint8_t> touched, std::span<std::uint8_t> full) {
    HWY_DYNAMIC_DISPATCH(splatCellsKernel)(weights, plane, row, touched, full);
}

}  // namespace deltasplat
#endif
