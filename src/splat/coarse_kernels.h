// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "deltasplat/splat/footprint.h"
#include "splat/tile_kernels.h"

namespace deltasplat {

/// Of sheets whose pixels voxels share, what the kernel takes: a pixel is the sum over its cell and
/// half a cell around it, by the weights of a tent.
struct CoarseWeights {
    static bool fits(const Footprint& footprint) { return footprint.voxelsPerPixel > 1; }
    /// @param footprint  one that fits
    CoarseWeights(const Footprint& footprint, int sheetChannels)
        : voxelsPerPixel(footprint.voxelsPerPixel), channels(sheetChannels) {}

    int voxelsPerPixel;  ///< 2, 4 or 8
    int channels;        ///< of plane and sheet: 1 or 4
};

/// As splatCells, for footprints of CoarseWeights; the first tile's voxels begin at its first
/// pixel's cell.
void splatCoarse(const CoarseWeights& weights, const PlaneRow& plane, const TileRow& row,
                 std::span<const std::uint8_t> touched, std::span<std::uint8_t> full);

}  // namespace deltasplat
