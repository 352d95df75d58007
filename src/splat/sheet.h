// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <limits>
#include <memory_resource>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/bits.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/splat/footprint.h"
#include "splat/tile_bytes.h"
#include "splat/tile_kernels.h"

namespace deltasplat {

/// The rows of tiles that footprints of a block's 8x8 voxels reach, from the first reached on.
class BlockReach {
  public:
    /// @param resolution   sheet pixels a voxel
    /// @param reachPixels  as Footprint::reach
    /// @param width        of the footprint, in pixels
    BlockReach(int resolution, int reachPixels, int width);

    /// First reached tile, counted from the tile of the block's first voxel; <= 0.
    int firstTile() const { return firstTile_; }
    /// Reached tiles along a row, and along a column.
    int tiles() const { return tiles_; }

    /// Returns voxel rows, bit u, with any of `voxels` (bit 8 * u + v) that reaches a tile column.
    std::uint8_t rowsReaching(int tileColumn, std::uint64_t voxels) const {
        return rowsWithAny(voxels & columns_[tileColumn]);
    }
    /// Returns the pixel rows that footprints of rows of voxels reach, in the eight rows of tiles
    /// from 8 * `group` on: bit y of byte i is row y of the tile in the i-th of them.
    std::uint64_t pixelRows(int group, std::uint8_t voxelRows) const {
        return pixelRows_[group][voxelRows];
    }

  private:
    int firstTile_;
    int tiles_;
    std::vector<std::uint64_t> columns_;  // [tile column]: voxels that reach it
    // [tile row / 8][rows of voxels]
    std::vector<std::array<std::uint64_t, 256>> pixelRows_;
};

/// Where sheet pixels lie. Pixels run along v, rows along u: the order of a leaf's voxels. Pixel p
/// is at voxel position (p - marginPixels + offsetPixels) / resolution + firstVoxel. The margin
/// takes footprints over the edge, and keeps the outermost pixels zero.
struct SheetLayout {
    int resolution = 1;        ///< as Footprint::resolution
    int firstSlice = 0;        ///< slice of the volume that lies on the base plane unshifted
    glm::ivec2 firstVoxel{0};  ///< (v, u), multiples of 8: tiles begin with blocks
    glm::ivec2 blocks{0};      ///< blocks of 8x8 voxels along (v, u)
    /// A multiple of kTilePixels, at least one more than the footprint reaches.
    int marginPixels = 0;
    glm::ivec2 sizePixels{0};  ///< multiples of kTilePixels
    glm::ivec2 origin{0};      ///< first pixel of this part in the whole sheet
    int reachPixels = 0;       ///< as Footprint::reach
    int footprintPixels = 1;   ///< as Footprint::width
    double offsetPixels = 0;   ///< as Footprint::offsetPixels
    int channels = 4;          ///< 4 (RGBA), or 1 where everything seen has one colour

    int blockPixels() const { return 8 * resolution; }
    glm::ivec2 tiles() const { return sizePixels / kTilePixels; }
    /// Pixels from one row to the next; longer than a row, because vectors reach over its end.
    std::size_t pitchPixels() const { return std::size_t(sizePixels.x) + kTilePixels; }
    std::size_t bytes() const {
        return sizeof(std::int32_t) * channels * pitchPixels() * sizePixels.y;
    }
    /// First pixel of the footprint of the voxel at (v, u), as a place in pixels.
    std::size_t stampPlace(glm::ivec2 voxel) const {
        const glm::ivec2 p = (voxel - firstVoxel) * resolution + marginPixels - reachPixels;
        return std::size_t(p.y) * pitchPixels() + p.x;
    }

    bool operator==(const SheetLayout&) const = default;
};

/// Pixels [min, max) of a sheet.
struct SheetBox {
    glm::ivec2 min{0};
    glm::ivec2 max{0};
};

/// Returns the sheet pixels [x, y) along an axis reached by a row or column of blocks.
glm::ivec2 pixelsReached(const SheetLayout& layout, int block);

/// Returns the rows of blocks [x, y) that reach sheet rows [first, last); none if y <= x.
glm::ivec2 blocksReaching(const SheetLayout& layout, int first, int last);

/// Blocks [first, last] of a sheet, (v, u).
struct BlockBox {
    glm::ivec2 first{0};
    glm::ivec2 last{std::numeric_limits<int>::max()};
};

/// Lays out the part of a sheet in which a box's pixels are complete: blocks that reach them.
/// @param among  blocks to choose from
SheetLayout layoutPart(const SheetLayout& whole, const SheetBox& box, const BlockBox& among = {});

/// @throw Error(kUsage) if pixels cannot be counted in 32 bits, as stamps do
void requireCountable(const SheetLayout& layout);

/// Lays out a sheet for the voxels of a (slice, u, v) box.
/// @throw Error(kUsage) if rows or columns cannot be counted in 32 bits
SheetLayout layoutSheet(const IndexBox& box, const Footprint& footprint, int channels = 4);

/// The running splat of the current slice: 32-bit integers `[row][pitch][channels]`, in slice
/// coordinates. Tracks rows of tiles that may not be zero, because integers return to exact zero.
class Sheet {
  public:
    /// @param memory  for the pixels
    explicit Sheet(const SheetLayout& layout,
                   std::pmr::memory_resource& memory = *std::pmr::get_default_resource());

    const SheetLayout& layout() const { return layout_; }
    /// Becomes another part of the same sheet, up to its first size. Every pixel must be zero.
    void setLayout(const SheetLayout& layout) { layout_ = layout; }
    /// Integers from one row to the next.
    std::size_t pitch() const { return layout_.channels * layout_.pitchPixels(); }
    std::int32_t* pixels() { return pixels_.data(); }
    const std::int32_t* row(int y) const { return &pixels_[pitch() * y]; }

    /// Marks tile rows that a block (v, u) may have changed.
    /// @param voxels  a mask word, bit 8 * u + v
    void touch(glm::ivec2 block, std::uint64_t voxels);
    /// Marks what voxels of a block reach: rows of visible ones as full, because no colour or
    /// weight is negative, and rows reached only by vanished ones as touched.
    void show(glm::ivec2 block, std::uint64_t visible, std::uint64_t vanished);
    /// Sets the rows that voxels of a block reach, in `marks` [markBytes()] laid out as fullRows().
    void mark(glm::ivec2 block, std::uint64_t voxels, std::span<std::uint8_t> marks) const;
    std::size_t markBytes() const { return full_.size(); }
    /// Calls `refill(tileRow, touched, full)` for rows of tiles with touched pixel rows in [first,
    /// last). Both spans have a byte per tile, bit y for its row y: for bits in `touched`, `refill`
    /// sets in `full` whether the row is not all zero.
    /// @param isHidden  whether a tile (column, row) may stay touched; null: none may
    template <typename IsHidden, typename Refill>
    void refillTouched(int first, int last, const IsHidden& isHidden, const Refill& refill);
    template <typename Refill>
    void refillTouched(int first, int last, const Refill& refill) {
        refillTouched(first, last, nullptr, refill);
    }
    /// Finds touched rows of zeros, once all stamps of a slice are in.
    void settle();
    /// Becomes the sum of the sheets of a colour's digits (addLowDigits), of this layout, in the
    /// rows of tiles that have any of [firstRow, lastRow).
    void addDigits(const Sheet& high, const Sheet& low, int firstRow, int lastRow);
    void clear();
    /// Returns a byte per tile of a tile row, and zeros up to a multiple of eight: bit y is set
    /// where row y of the tile may be other than zero.
    std::span<const std::uint8_t> fullRows(int tileRow) const {
        return {&full_[bytesPerRow_ * tileRow], bytesPerRow_};
    }
    /// A block's tile, for footprints of one pixel.
    struct Tile {
        std::uint8_t& full;  ///< as in fullRows()
        std::int32_t* pixels;
    };
    Tile tileOf(glm::ivec2 block) { return tileAt(block + layout_.marginPixels / kTilePixels); }
    /// Returns the rows of a block's tile, a bit each, that are in pixel rows [first, last).
    unsigned rowsOfTile(glm::ivec2 block, int first, int last) const {
        return rowsOfTile(block.y + layout_.marginPixels / kTilePixels, first, last);
    }
    void clear(const Tile& tile);
    TileRow tileRow(int row) { return {&pixels_[pitch() * row * kTilePixels], pitch()}; }

  private:
    Tile tileAt(glm::ivec2 tile) {
        return {full_[bytesPerRow_ * tile.y + tile.x],
                &pixels_[(pitch() * tile.y + layout_.channels * tile.x) * kTilePixels]};
    }
    void clearRows(int tileRow);
    glm::ivec2 firstTileOf(glm::ivec2 block) const;
    template <std::size_t kMasks, typename Use>
    void forReach(glm::ivec2 block, const std::uint64_t (&voxels)[kMasks], const Use& use) const;
    void touchRows(glm::ivec2 block);
    bool leaveOthers(std::span<std::uint8_t> touched, unsigned rows);

    static constexpr unsigned kAllRows = (1u << kTilePixels) - 1;
    // Returns the rows of a row of tiles, a bit each, that are in pixel rows [first, last).
    static unsigned rowsOfTile(int tileRow, int first, int last) {
        const int top = kTilePixels * tileRow;
        return kAllRows << std::max(first - top, 0) &
               kAllRows >> std::max(top + kTilePixels - last, 0);
    }

    SheetLayout layout_;
    BlockReach reach_;
    std::size_t bytesPerRow_;
    std::pmr::vector<std::int32_t> pixels_;
    std::vector<std::uint8_t> full_;         // [tile row][bytesPerRow_]
    std::vector<std::uint8_t> touched_;      // likewise
    std::vector<std::uint8_t> touchedRows_;  // [tile row]: whether any row is touched
    std::vector<std::uint8_t> left_;         // [bytesPerRow_], zeros: tiles that stay touched
};

template <typename IsHidden, typename Refill>
void Sheet::refillTouched(int first, int last, const IsHidden& isHidden, const Refill& refill) {
    if (last <= first) return;
    const int end = (std::min(last, layout_.sizePixels.y) + kTilePixels - 1) / kTilePixels;
    for (int row = std::max(first, 0) / kTilePixels; row < end; ++row) {
        if (touchedRows_[row] == 0) continue;
        touchedRows_[row] = 0;
        const std::span touched(&touched_[bytesPerRow_ * row], bytesPerRow_);
        const unsigned rows = rowsOfTile(row, first, last);
        bool isLeft = rows != kAllRows && leaveOthers(touched, rows);
        if constexpr (!std::is_null_pointer_v<IsHidden>) {
            forTiles(touched, [&](std::size_t i) {
                if (!isHidden(glm::ivec2(int(i), row))) return;
                left_[i] |= std::exchange(touched[i], std::uint8_t{0});
                isLeft = true;
            });
        }
        refill(row, touched, std::span(&full_[bytesPerRow_ * row], bytesPerRow_));
        std::fill(touched.begin(), touched.end(), std::uint8_t{0});
        if (!isLeft) continue;
        touchedRows_[row] = 1;
        std::swap_ranges(touched.begin(), touched.end(), left_.begin());
    }
}

}  // namespace deltasplat
