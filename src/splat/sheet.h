// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/splat/footprint.h"
#include "splat/sheet_kernels.h"

namespace deltasplat {

/// Where sheet pixels lie: pixel p is at voxel position (p - marginPixels) / resolution +
/// firstVoxel. The margin takes footprints that reach over the edge, and keeps the outermost pixels
/// zero.
struct SheetLayout {
    int resolution = 1;
    int firstSlice = 0;        ///< of the volume: the slice that lies on the base plane unshifted
    glm::ivec2 firstVoxel{0};  ///< (u, v), multiples of 8
    int marginPixels =
        0;  ///< a multiple of kTilePixels, at least one more than the footprint reaches
    glm::ivec2 sizePixels{0};  ///< multiples of kTilePixels

    glm::ivec2 tiles() const { return sizePixels / kTilePixels; }
    /// Pixels from one row to the next; longer than a row by what a vector may reach over its end.
    std::size_t pitchPixels() const { return std::size_t(sizePixels.x) + kTilePixels; }
    std::size_t bytes() const { return 16 * pitchPixels() * sizePixels.y; }
    /// Place of the upper left pixel of the footprint of the voxel at (u, v), in pixels.
    std::size_t stampPlace(glm::ivec2 voxel, int radius) const {
        const glm::ivec2 p = (voxel - firstVoxel) * resolution + marginPixels - radius;
        return std::size_t(p.y) * pitchPixels() + p.x;
    }
};

/// Lays out a sheet for the voxels of a (slice, u, v) box.
/// @throw Error(kUsage) if it would have more pixels than can be counted in 32 bits, or does not
/// fit into memory
SheetLayout layoutSheet(const IndexBox& box, const Footprint& footprint);

/// The running splat of the current slice: 32-bit integer RGBA `[row][pitch][4]`, rows along v, in
/// slice coordinates. Knows which tiles hold anything but zeros: integers return to exact zero, so
/// that can be told exactly.
class Sheet {
  public:
    explicit Sheet(const SheetLayout& layout);

    const SheetLayout& layout() const { return layout_; }
    std::int32_t* pixels() { return pixels_.data(); }
    const std::int32_t* row(int y) const { return &pixels_[4 * layout_.pitchPixels() * y]; }

    /// Says that pixels of [first, last], both inclusive, may have changed.
    void touch(glm::ivec2 first, glm::ivec2 last);
    /// Finds out which of the touched tiles are zero. Call it when all stamps of a slice are in.
    void settle();
    /// Makes every pixel zero.
    void clear();
    /// Returns one bit for each tile of a tile row, set where it is not all zero.
    std::span<const std::uint64_t> occupiedTiles(int tileRow) const {
        return {&occupied_[wordsPerRow_ * tileRow], wordsPerRow_};
    }

  private:
    std::int32_t* tile(int tileRow, int column);

    SheetLayout layout_;
    std::size_t wordsPerRow_;
    std::vector<std::int32_t> pixels_;
    std::vector<std::uint64_t> occupied_;  // [tile row][wordsPerRow_]
    std::vector<std::uint64_t> touched_;   // likewise
};

}  // namespace deltasplat
