// SPDX-License-Identifier: Apache-2.0
#include "splat/sheet.h"

#include <algorithm>
#include <array>
#include <bit>
#include <glm/vec2.hpp>
#include <limits>
#include <string>

#include "base/bits.h"
#include "deltasplat/error.h"
#include "splat/tile_bytes.h"
#include "splat/tile_kernels.h"

namespace deltasplat {

namespace {

int roundUpToTile(int pixels) {
    return (pixels + kTilePixels - 1) / kTilePixels * kTilePixels;
}

std::string sizeText(const glm::i64vec2& size) {
    return std::to_string(size.x) + "x" + std::to_string(size.y) + " pixels";
}

// Rows and columns need 31 bits, wherever a slice is shifted to.
void requireShort(const glm::i64vec2& size, std::int64_t shift) {
    const std::int64_t longest =
        std::numeric_limits<std::int32_t>::max() - 2 * kTilePixels - 2 * shift;
    if (std::max(size.x, size.y) <= longest) return;
    throw Error(ErrorCode::kUsage, "sheet", sizeText(size),
                "at most " + std::to_string(std::max<std::int64_t>(longest, 0)) +
                    " each way, a smaller `resolution`");
}

}  // namespace

void requireCountable(const SheetLayout& layout) {
    const double most = std::numeric_limits<std::uint32_t>::max();
    if (double(layout.pitchPixels()) * layout.sizePixels.y <= most) return;
    throw Error(ErrorCode::kUsage, "sheet", sizeText(layout.sizePixels),
                "at most 4294967295, a smaller `resolution`");
}

SheetLayout layoutSheet(const IndexBox& box, const Footprint& footprint, int channels) {
    SheetLayout layout;
    layout.resolution = footprint.resolution;
    layout.reachPixels = footprint.reach();
    layout.footprintPixels = footprint.width;
    layout.offsetPixels = footprint.offsetPixels();
    layout.channels = channels;
    // One tile beyond the footprint stays zero: compositing reads one pixel beyond occupied ones.
    layout.marginPixels = roundUpToTile(footprint.reach()) + kTilePixels;
    layout.firstSlice = box.min.x;
    const glm::ivec2 first = glm::ivec2(box.min.z, box.min.y) >> 3;
    const glm::ivec2 last = glm::ivec2(box.max.z, box.max.y) >> 3;
    const glm::i64vec2 blocks = glm::i64vec2(last) - glm::i64vec2(first) + std::int64_t{1};
    layout.firstVoxel = 8 * first;
    const glm::i64vec2 size =
        std::int64_t{layout.blockPixels()} * blocks + std::int64_t{2 * layout.marginPixels};
    const std::int64_t slices = std::int64_t{box.max.x} - box.min.x + 1;
    requireShort(size, slices * footprint.resolution);
    layout.blocks = glm::ivec2(blocks);
    layout.sizePixels = glm::ivec2(size);
    return layout;
}

glm::ivec2 pixelsReached(const SheetLayout& layout, int block) {
    const int begin = layout.marginPixels - layout.reachPixels + block * layout.blockPixels();
    return {begin, begin + layout.blockPixels() - layout.resolution + layout.footprintPixels};
}

namespace {

// Along one axis with this many blocks.
glm::ivec2 reachingOf(const SheetLayout& layout, int blocks, int first, int last) {
    const int blockPixels = layout.blockPixels();
    const glm::ivec2 reached = pixelsReached(layout, 0);
    return {std::max(floorDiv(first - reached.y, blockPixels) + 1, 0),
            std::min(floorDiv(last - 1 - reached.x, blockPixels) + 1, blocks)};
}

}  // namespace

glm::ivec2 blocksReaching(const SheetLayout& layout, int first, int last) {
    return reachingOf(layout, layout.blocks.y, first, last);
}

SheetLayout layoutPart(const SheetLayout& whole, const SheetBox& box, const BlockBox& among) {
    const int blockPixels = whole.blockPixels();
    SheetLayout part = whole;
    for (int axis = 0; axis < 2; ++axis) {
        glm::ivec2 blocks = reachingOf(whole, whole.blocks[axis], box.min[axis], box.max[axis]);
        blocks = {std::max(blocks.x, among.first[axis]),
                  std::min<int>(blocks.y - 1, among.last[axis]) + 1};
        part.blocks[axis] = std::max(blocks.y - blocks.x, 0);
        part.firstVoxel[axis] += 8 * blocks.x;
        part.origin[axis] = blockPixels * blocks.x;
        part.sizePixels[axis] += blockPixels * (part.blocks[axis] - whole.blocks[axis]);
    }
    return part;
}

Sheet::Sheet(const SheetLayout& layout, std::pmr::memory_resource& memory)
    : layout_(layout),
      reach_(layout.resolution, layout.reachPixels, layout.footprintPixels),
      bytesPerRow_((layout.tiles().x + 7) / 8 * 8),
      pixels_(layout.bytes() / sizeof(std::int32_t), &memory),
      full_(bytesPerRow_ * layout.tiles().y),
      touched_(full_.size()),
      touchedRows_(layout.tiles().y),
      left_(bytesPerRow_) {}

// Margins and blocks begin at tiles.
glm::ivec2 Sheet::firstTileOf(glm::ivec2 block) const {
    return layout_.resolution * block + layout_.marginPixels / kTilePixels + reach_.firstTile();
}

void Sheet::touch(glm::ivec2 block, std::uint64_t voxels) {
    forReach(block, {voxels},
             [&](std::size_t place, const auto& reached) { touched_[place] |= reached[0]; });
    touchRows(block);
}

void Sheet::show(glm::ivec2 block, std::uint64_t visible, std::uint64_t vanished) {
    forReach(block, {visible, vanished}, [&](std::size_t place, const auto& reached) {
        full_[place] |= reached[0];
        touched_[place] |= std::uint8_t(reached[1] & ~reached[0]);
    });
    if (vanished != 0) touchRows(block);
}

void Sheet::mark(glm::ivec2 block, std::uint64_t voxels, std::span<std::uint8_t> marks) const {
    forReach(block, {voxels},
             [&](std::size_t place, const auto& reached) { marks[place] |= reached[0]; });
}

// Calls use(place, reached) for every tile that a block may reach: the place of its byte in full_
// and touched_, and the reached rows per mask. Byte by byte, because the next block begins inside
// these tiles, and the processor waits on reads larger than the writes before them.
template <std::size_t kMasks, typename Use>
void Sheet::forReach(glm::ivec2 block, const std::uint64_t (&voxels)[kMasks],
                     const Use& use) const {
    // As most footprints do, so that loops unroll.
    constexpr int kMostReach = 3;
    const glm::ivec2 first = firstTileOf(block);
    const auto forGroup = [&](int column, int row, auto columns, auto rows) {
        // Per column of tiles, a byte per row of them.
        std::uint64_t reached[kMasks][8];
        for (std::size_t i = 0; i < kMasks; ++i) {
            for (int x = 0; x < columns; ++x) {
                const std::uint8_t from = reach_.rowsReaching(column + x, voxels[i]);
                reached[i][x] = reach_.pixelRows(row / 8, from);
            }
        }
        for (int y = 0; y < rows; ++y) {
            const std::size_t place = bytesPerRow_ * (first.y + row + y) + first.x + column;
            for (int x = 0; x < columns; ++x) {
                std::array<std::uint8_t, kMasks> here;
                for (std::size_t i = 0; i < kMasks; ++i)
                    here[i] = std::uint8_t(reached[i][x] >> 8 * y);
                use(place + x, here);
            }
        }
    };
    if (reach_.tiles() == kMostReach) {
        constexpr std::integral_constant<int, kMostReach> kTiles;
        return forGroup(0, 0, kTiles, kTiles);
    }
    for (int column = 0; column < reach_.tiles(); column += 8) {
        for (int row = 0; row < reach_.tiles(); row += 8)
            forGroup(column, row, std::min(reach_.tiles() - column, 8),
                     std::min(reach_.tiles() - row, 8));
    }
}

void Sheet::touchRows(glm::ivec2 block) {
    std::fill_n(&touchedRows_[firstTileOf(block).y], reach_.tiles(), std::uint8_t{1});
}

// Moves the bits of all but some rows from `touched` to left_. Returns whether there are any.
bool Sheet::leaveOthers(std::span<std::uint8_t> touched, unsigned rows) {
    unsigned left = 0;
    for (std::size_t i = 0; i < touched.size(); ++i) {
        left_[i] = std::uint8_t(touched[i] & ~rows);
        touched[i] = std::uint8_t(touched[i] & rows);
        left |= left_[i];
    }
    return left != 0;
}

void Sheet::settle() {
    refillTouched(
        0, layout_.sizePixels.y,
        [&](int row, std::span<const std::uint8_t> touched, std::span<std::uint8_t> full) {
            findFullRows(tileRow(row), layout_.channels, touched, full);
        });
}

void Sheet::addDigits(const Sheet& high, const Sheet& low, int firstRow, int lastRow) {
    const int first = std::max(firstRow, 0) / kTilePixels;
    const int end = (std::min(lastRow, layout_.sizePixels.y) + kTilePixels - 1) / kTilePixels;
    std::vector<std::uint8_t> rows(bytesPerRow_);
    for (int row = first; row < end; ++row) {
        clearRows(row);
        const std::span highRows = high.fullRows(row);
        const std::span lowRows = low.fullRows(row);
        for (std::size_t i = 0; i < rows.size(); ++i)
            rows[i] = std::uint8_t(highRows[i] | lowRows[i]);
        const int y = kTilePixels * row;
        addLowDigits({high.row(y), low.row(y), pitch()}, layout_.channels, rows, tileRow(row).sheet,
                     std::span(&full_[bytesPerRow_ * row], bytesPerRow_));
    }
}

void Sheet::clearRows(int tileRow) {
    forTiles(std::span(&full_[bytesPerRow_ * tileRow], bytesPerRow_), [&](std::size_t column) {
        clear(tileAt({int(column), tileRow}));
    });
}

void Sheet::clear(const Tile& tile) {
    for (unsigned rest = tile.full; rest != 0; rest &= rest - 1)
        std::fill_n(tile.pixels + pitch() * std::countr_zero(rest), kTilePixels * layout_.channels,
                    0);
    tile.full = 0;
}

void Sheet::clear() {
    settle();
    for (int row = 0; row < layout_.tiles().y; ++row) clearRows(row);
}

BlockReach::BlockReach(int resolution, int reachPixels, int width)
    : firstTile_(floorDiv(-reachPixels, kTilePixels)),
      tiles_(floorDiv(7 * resolution - reachPixels + width - 1, kTilePixels) - firstTile_ + 1),
      columns_(std::size_t(tiles_)),
      pixelRows_(std::size_t(tiles_ + 7) / 8) {
    for (int tile = 0; tile < tiles_; ++tile) {
        // The tile's pixels that each voxel of a row or column reaches.
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
