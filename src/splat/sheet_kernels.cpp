// SPDX-License-Identifier: Apache-2.0
// The splatter's inner loops, compiled once for each SIMD level. All of it is integer arithmetic,
// so that every level gives the same bits.
#include "splat/sheet_kernels.h"

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
    const int vectors = (4 * weights.rowPixels + lanes - 1) / lanes;
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

HWY_EXPORT(addStampsKernel);
HWY_EXPORT(isTileZeroKernel);

StampWeights::StampWeights(const Footprint& footprint)
    : rows(footprint.width()),
      rowLength((footprint.width() + kMaxVectorPixels - 1) / kMaxVectorPixels * 4 *
                kMaxVectorPixels),
      rowPixels(footprint.width()),
      weights(rows * rowLength) {
    for (int v = 0; v < rows; ++v) {
        for (int u = 0; u < footprint.width(); ++u) {
            for (int c = 0; c < 4; ++c) weights[v * rowLength + 4 * u + c] = footprint.at(u, v);
        }
    }
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
