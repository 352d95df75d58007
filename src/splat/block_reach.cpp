// SPDX-License-Identifier: Apache-2.0
#include "splat/block_reach.h"

#include <glm/vec2.hpp>

#include "base/bits.h"
#include "splat/tile_kernels.h"

namespace deltasplat {

BlockReach::BlockReach(int resolution, int reachPixels, int width)
    : firstTile_(floorDiv(-reachPixels, kTilePixels)),
      tiles_(floorDiv(7 * resolution - reachPixels + width - 1, kTilePixels) - firstTile_ + 1),
      columns_(std::size_t(tiles_)),
      pixelRows_(std::size_t(tiles_ + 7) / 8) {
    for (int tile = 0; tile < tiles_; ++tile) {
        // Which of the tile's pixels each voxel of a row or column reaches.
        std::array<std::uint8_t, 8> pixels{};
        for (int voxel = 0; voxel < 8; ++voxel) {
            const int first = resolution * voxel - reachPixels - kTilePixels * (firstTile_ + tile);
            for (int p = 0; p < kTilePixels; ++p)
                if (p >= first && p < first + width) pixels[voxel] |= std::uint8_t(1 << p);
            if (pixels[voxel] != 0) columns_[tile] |= std::uint64_t{0x0101010101010101} << voxel;
        }
        for (int rows = 0; rows < 256; ++rows) {
            for (int voxel = 0; voxel < 8; ++voxel) {
                if (rows >> voxel & 1)
                    pixelRows_[tile / 8][rows] |= std::uint64_t{pixels[voxel]} << 8 * (tile % 8);
            }
        }
    }
}

}  // namespace deltasplat
