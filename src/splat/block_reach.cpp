// SPDX-License-Identifier: Apache-2.0
#include "splat/block_reach.h"

#include <glm/vec2.hpp>

#include "floor_div.h"
#include "splat/tile_kernels.h"

namespace deltasplat {

BlockReach::BlockReach(int resolution, int reachPixels, int width)
    : firstTile_(floorDiv(-reachPixels, kTilePixels)),
      tiles_(floorDiv(7 * resolution - reachPixels + width - 1, kTilePixels) - firstTile_ + 1) {
    phases_.push_back(phaseOf([&](int voxel) {
        const int first = resolution * voxel - reachPixels;
        return glm::ivec2(first, first + width);
    }));
}

BlockReach::BlockReach(int voxelsPerPixel) : firstTile_(-1), tiles_(3) {
    for (int phase = 0; phase < voxelsPerPixel; ++phase) {
        phases_.push_back(phaseOf([&](int voxel) {
            // Between the middles of two pixels: of which the second is this.
            const int second = floorDiv(8 * phase + voxel + voxelsPerPixel / 2, voxelsPerPixel);
            return glm::ivec2(second - 1, second + 1);
        }));
    }
}

// @param pixelsOf  of a voxel in a row or column: the pixels [x, y) that it reaches, counted from
//                  the first of the tile in which the block's first voxel lies
template <typename PixelsOf>
BlockReach::Phase BlockReach::phaseOf(const PixelsOf& pixelsOf) const {
    Phase phase;
    phase.columns.resize(tiles_);
    phase.pixelRows.resize((tiles_ + 7) / 8);
    for (int tile = 0; tile < tiles_; ++tile) {
        // Which of the tile's pixels each voxel of a row or column reaches.
        std::array<std::uint8_t, 8> pixels{};
        for (int voxel = 0; voxel < 8; ++voxel) {
            const glm::ivec2 reached = pixelsOf(voxel) - kTilePixels * (firstTile_ + tile);
            for (int p = 0; p < kTilePixels; ++p) {
                if (p >= reached.x && p < reached.y) pixels[voxel] |= std::uint8_t(1 << p);
            }
            if (pixels[voxel] != 0)
                phase.columns[tile] |= std::uint64_t{0x0101010101010101} << voxel;
        }
        for (int rows = 0; rows < 256; ++rows) {
            for (int voxel = 0; voxel < 8; ++voxel) {
                if (rows >> voxel & 1)
                    phase.pixelRows[tile / 8][rows] |= std::uint64_t{pixels[voxel]}
                                                       << 8 * (tile % 8);
            }
        }
    }
    return phase;
}

}  // namespace deltasplat
