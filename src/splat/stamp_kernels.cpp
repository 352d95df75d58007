// SPDX-License-Identifier: Apache-2.0
// The inner loops of splatting stamp by stamp, compiled once for each SIMD level. All of it is
// integer arithmetic, so that every level gives the same bits.
#include "splat/stamp_kernels.h"

#include <bit>

#include "bit_matrix.h"
#include "simd_targets.h"
#include "splat/tile_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splat/stamp_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Wider vectors are slower here: consecutive stamps overlap, and what was just stored can only be
// forwarded to a load of the same place and width.
constexpr std::size_t kMaxLanes = 8;
using IntTag = hn::CappedTag<std::int32_t, kMaxLanes>;

HWY_INLINE auto loadStamp(IntTag tag, const std::array<std::int32_t, 4>& color, int channels) {
    return channels == 4 ? hn::LoadDup128(tag, color.data()) : hn::Set(tag, color[3]);
}

// Adds stamps whose rows take `vectors` vectors: known at compile time for the usual footprints, so
// that the loops over a row unroll.
template <int kVectors>
void addStampsOfWidth(std::int32_t* HWY_RESTRICT sheet, std::size_t pitch,
                      const StampWeights& weights, const StampList& stamps, int vectors) {
    const IntTag tag;
    const std::size_t lanes = hn::Lanes(tag);
    const std::int32_t* HWY_RESTRICT table = weights.weights.data();
    const std::size_t rowLength = weights.rowLength;
    const int rows = weights.rows;
    const int channels = weights.channels;
    for (std::size_t i = 0; i < stamps.count; ++i) {
        const auto color = loadStamp(tag, stamps.colors[i], channels);
        std::int32_t* HWY_RESTRICT row = sheet + std::size_t(channels) * stamps.places[i];
        const std::int32_t* HWY_RESTRICT w = table;
        for (int y = 0; y < rows; ++y, row += pitch, w += rowLength) {
            for (int x = 0; x < (kVectors ? kVectors : vectors); ++x) {
                const auto weight = hn::LoadU(tag, w + x * lanes);
                const auto sum = hn::LoadU(tag, row + x * lanes);
                hn::StoreU(hn::Add(sum, hn::Mul(color, weight)), tag, row + x * lanes);
            }
        }
    }
}

void addStampsKernel(std::int32_t* HWY_RESTRICT sheet, std::size_t pitch,
                     const StampWeights& weights, const StampList& stamps) {
    const int lanes = int(hn::Lanes(IntTag()));
    const int vectors = (weights.channels * weights.rows + lanes - 1) / lanes;
    switch (vectors) {
        case 1:
            return addStampsOfWidth<1>(sheet, pitch, weights, stamps, 1);
        case 2:
            return addStampsOfWidth<2>(sheet, pitch, weights, stamps, 2);
        case 3:
            return addStampsOfWidth<3>(sheet, pitch, weights, stamps, 3);
        case 4:
            return addStampsOfWidth<4>(sheet, pitch, weights, stamps, 4);
        default:
            return addStampsOfWidth<0>(sheet, pitch, weights, stamps, vectors);
    }
}

// Calls list(n) for the active voxels of a slice, along u first: that is down the rows of the
// sheet, where consecutive stamps meet the very vectors that were just stored.
template <typename List>
HWY_INLINE void forActive(std::uint64_t active, const List& list) {
    for (std::uint64_t rest = transposedBits(active); rest != 0; rest &= rest - 1) {
        const int n = std::countr_zero(rest);
        list(8 * (n & 7) + (n >> 3));
    }
}

// One pixel's worth of integers, and as many of a class table's entries.
using ColorTag = hn::FixedTag<std::int32_t, 4>;
using EntryTag = hn::Rebind<std::int16_t, ColorTag>;

HWY_INLINE auto loadColor(const ClassTable::Color& color) {
    return hn::PromoteTo(ColorTag(), hn::LoadU(EntryTag(), color.data()));
}

void listWholeKernel(const BlockSlice& slice, const ClassTable::Color* HWY_RESTRICT colors,
                     StampList& stamps) {
    std::size_t count = stamps.count;
    forActive(slice.active, [&](int n) {
        stamps.places[count] = slice.place + slice.placeInBlock[n];
        hn::Store(loadColor(colors[slice.classes[n]]), ColorTag(), stamps.colors[count].data());
        ++count;
    });
    stamps.count = count;
}

void listChangesKernel(const BlockSlice& slice, const ClassTable::Color* HWY_RESTRICT colors,
                       std::uint16_t* HWY_RESTRICT shown, StampList& stamps) {
    std::size_t count = stamps.count;
    forActive(slice.active, [&](int n) {
        const auto before = loadColor(colors[shown[n]]);
        shown[n] = slice.classes[n];
        stamps.places[count] = slice.place + slice.placeInBlock[n];
        hn::Store(hn::Sub(loadColor(colors[shown[n]]), before), ColorTag(),
                  stamps.colors[count].data());
        ++count;
    });
    stamps.count = count;
}

std::uint8_t findFullRowsKernel(const std::int32_t* HWY_RESTRICT tile, std::size_t pitch,
                                int channels, std::uint8_t rows) {
    const hn::CappedTag<std::int32_t, 8> tag;
    const std::size_t length = std::size_t{kTilePixels} * channels;
    unsigned full = 0;
    for (unsigned rest = rows; rest != 0; rest &= rest - 1) {
        const int y = std::countr_zero(rest);
        // Whether a row is full is hard to foretell: looking at all of it is faster than stopping.
        auto any = hn::Zero(tag);
        for (std::size_t x = 0; x < length; x += hn::Lanes(tag))
            any = hn::Or(any, hn::LoadU(tag, tile + y * pitch + x));
        full |= unsigned{!hn::AllTrue(tag, hn::Eq(any, hn::Zero(tag)))} << y;
    }
    return std::uint8_t(full);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(listWholeKernel);
HWY_EXPORT(listChangesKernel);
HWY_EXPORT(addStampsKernel);
HWY_EXPORT(findFullRowsKernel);

StampWeights::StampWeights(const Footprint& footprint, int sheetChannels)
    : channels(sheetChannels),
      rows(footprint.width),
      // The widest vectors have eight lanes.
      rowLength((std::size_t(footprint.width) * sheetChannels + 7) / 8 * 8),
      weights(rows * rowLength) {
    for (int y = 0; y < rows; ++y) {
        for (int i = 0; i < rows * channels; ++i) {
            weights[y * rowLength + i] = footprint.at(i / channels, y);
        }
    }
}

void listWhole(const BlockSlice& slice, const ClassTable::Color* colors, StampList& stamps) {
    HWY_DYNAMIC_DISPATCH(listWholeKernel)(slice, colors, stamps);
}

void listChanges(const BlockSlice& slice, const ClassTable::Color* colors, std::uint16_t* shown,
                 StampList& stamps) {
    HWY_DYNAMIC_DISPATCH(listChangesKernel)(slice, colors, shown, stamps);
}

void addStamps(std::int32_t* sheet, std::size_t pitch, const StampWeights& weights,
               StampList& stamps) {
    HWY_DYNAMIC_DISPATCH(addStampsKernel)(sheet, pitch, weights, stamps);
    stamps.count = 0;
}

std::uint8_t findFullRows(const std::int32_t* tile, std::size_t pitch, int channels,
                          std::uint8_t rows) {
    return HWY_DYNAMIC_DISPATCH(findFullRowsKernel)(tile, pitch, channels, rows);
}

}  // namespace deltasplat
#endif
