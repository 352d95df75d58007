// SPDX-License-Identifier: Apache-2.0
// The splatter's inner loops, compiled once for each SIMD level. All of it is integer arithmetic,
// so that every level gives the same bits.
#include "splat/sheet_kernels.h"

#include <bit>
#include <cstring>

#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splat/sheet_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Vectors of at most kMaxVectorPixels pixels.
using IntTag = hn::CappedTag<std::int32_t, 4 * kMaxVectorPixels>;

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
    for (std::size_t i = 0; i < stamps.count; ++i) {
        const auto color = hn::LoadDup128(tag, stamps.colors[i].data());
        std::int32_t* HWY_RESTRICT row = sheet + std::size_t{4} * stamps.places[i];
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
    const int vectors = (4 * weights.rows + lanes - 1) / lanes;
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

// One pixel's worth of integers, and as many of a class table's entries.
using ColorTag = hn::FixedTag<std::int32_t, 4>;
using EntryTag = hn::Rebind<std::uint16_t, ColorTag>;
using Entry = std::array<std::uint16_t, 4>;

HWY_INLINE auto loadColor(const Entry& entry) {
    return hn::PromoteTo(ColorTag(), hn::LoadU(EntryTag(), entry.data()));
}

void listWholeKernel(const LeafSlice& slice, const Entry* HWY_RESTRICT entries, StampList& stamps) {
    std::size_t count = stamps.count;
    for (std::uint64_t rest = slice.active; rest != 0; rest &= rest - 1) {
        const int n = std::countr_zero(rest);
        stamps.places[count] = slice.place + slice.placeInBlock[n];
        hn::Store(loadColor(entries[slice.values[n]]), ColorTag(), stamps.colors[count].data());
        ++count;
    }
    stamps.count = count;
}

void listChangesKernel(const LeafSlice& slice, const Entry* HWY_RESTRICT entries,
                       std::int32_t* HWY_RESTRICT slots, StampList& stamps) {
    std::size_t count = stamps.count;
    for (std::uint64_t rest = slice.active; rest != 0; rest &= rest - 1) {
        const int n = std::countr_zero(rest);
        const Entry& before = entries[slots[n]];
        const Entry& after = entries[slots[n] += slice.values[n]];
        stamps.places[count] = slice.place + slice.placeInBlock[n];
        hn::Store(hn::Sub(loadColor(after), loadColor(before)), ColorTag(),
                  stamps.colors[count].data());
        // What does not change in colour is overwritten by the next one: no branch to guess.
        count += std::bit_cast<std::uint64_t>(after) != std::bit_cast<std::uint64_t>(before);
    }
    stamps.count = count;
}

bool isTileZeroKernel(const std::int32_t* HWY_RESTRICT tile, std::size_t pitch) {
    const IntTag tag;
    const std::size_t lanes = hn::Lanes(tag);
    for (int y = 0; y < kTilePixels; ++y) {
        auto any = hn::Zero(tag);
        for (std::size_t x = 0; x < 4 * kTilePixels; x += lanes) {
            any = hn::Or(any, hn::LoadU(tag, tile + y * pitch + x));
        }
        if (!hn::AllTrue(tag, hn::Eq(any, hn::Zero(tag)))) return false;
    }
    return true;
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(listWholeKernel);
HWY_EXPORT(listChangesKernel);
HWY_EXPORT(addStampsKernel);
HWY_EXPORT(isTileZeroKernel);

StampWeights::StampWeights(const Footprint& footprint)
    : rows(footprint.width()),
      rowLength((footprint.width() + kMaxVectorPixels - 1) / kMaxVectorPixels * 4 *
                kMaxVectorPixels),
      weights(rows * rowLength) {
    for (int v = 0; v < rows; ++v) {
        for (int u = 0; u < footprint.width(); ++u) {
            for (int c = 0; c < 4; ++c) weights[v * rowLength + 4 * u + c] = footprint.at(u, v);
        }
    }
}

void listWhole(const LeafSlice& slice, const std::array<std::uint16_t, 4>* entries,
               StampList& stamps) {
    HWY_DYNAMIC_DISPATCH(listWholeKernel)(slice, entries, stamps);
}

void listChanges(const LeafSlice& slice, const std::array<std::uint16_t, 4>* entries,
                 std::int32_t* slots, StampList& stamps) {
    HWY_DYNAMIC_DISPATCH(listChangesKernel)(slice, entries, slots, stamps);
}

void addStamps(std::int32_t* sheet, std::size_t pitchPixels, const StampWeights& weights,
               StampList& stamps) {
    HWY_DYNAMIC_DISPATCH(addStampsKernel)(sheet, 4 * pitchPixels, weights, stamps);
    stamps.count = 0;
}

bool isTileZero(const std::int32_t* tile, std::size_t pitch) {
    return HWY_DYNAMIC_DISPATCH(isTileZeroKernel)(tile, pitch);
}

void clearTile(std::int32_t* tile, std::size_t pitch) {
    for (int y = 0; y < kTilePixels; ++y) {
        std::memset(tile + y * pitch, 0, 4 * kTilePixels * sizeof(std::int32_t));
    }
}

}  // namespace deltasplat
#endif
