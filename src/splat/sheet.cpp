// SPDX-License-Identifier: Apache-2.0
#include "splat/sheet.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>

#include "deltasplat/error.h"
#include "memory.h"

namespace deltasplat {
namespace {

int roundUpToTile(int pixels) {
    return (pixels + kTilePixels - 1) / kTilePixels * kTilePixels;
}

// Stamps name their place with 32 bits, and rows and columns are counted with 31.
void requireCountable(const glm::i64vec2& size) {
    const std::string text = std::to_string(size.x) + "x" + std::to_string(size.y);
    requireMemory("sheet of " + text + " pixels", 16.0 * double(size.x) * double(size.y));
    const double longest = std::numeric_limits<std::int32_t>::max() - 2 * kTilePixels;
    const double most = std::numeric_limits<std::uint32_t>::max();
    if (double(std::max(size.x, size.y)) <= longest &&
        double(size.x + kTilePixels) * double(size.y) <= most) {
        return;
    }
    throw Error(ErrorCode::kUsage, gotExpected("sheet", text + " pixels",
                                               "at most 4294967295, a smaller --resolution"));
}

// Sets the bits [first, last], both inclusive, of a row of words.
void setBits(std::uint64_t* words, int first, int last) {
    for (int word = first / 64; word <= last / 64; ++word) {
        const int low = std::max(first - 64 * word, 0);
        const int high = std::min(last - 64 * word, 63);
        words[word] |= (~std::uint64_t{0} >> (63 - high + low)) << low;
    }
}

}  // namespace

SheetLayout layoutSheet(const IndexBox& box, const Footprint& footprint) {
    SheetLayout layout;
    layout.resolution = footprint.resolution;
    // One tile more than the footprint needs stays zero: compositing goes one pixel over the
    // occupied ones.
    layout.marginPixels = roundUpToTile(footprint.radius) + kTilePixels;
    layout.firstSlice = box.min.x;
    const glm::ivec2 firstBlock{box.min.y >> 3, box.min.z >> 3};
    const glm::i64vec2 blocks =
        glm::i64vec2{box.max.y >> 3, box.max.z >> 3} - glm::i64vec2(firstBlock) + std::int64_t{1};
    layout.firstVoxel = 8 * firstBlock;
    const glm::i64vec2 size =
        std::int64_t{8 * footprint.resolution} * blocks + std::int64_t{2 * layout.marginPixels};
    requireCountable(size);
    layout.sizePixels = glm::ivec2(size);
    return layout;
}

Sheet::Sheet(const SheetLayout& layout)
    : layout_(layout),
      wordsPerRow_((layout.tiles().x + 63) / 64),
      pixels_(layout.bytes() / sizeof(std::int32_t)),
      occupied_(wordsPerRow_ * layout.tiles().y),
      touched_(occupied_.size()) {}

void Sheet::touch(glm::ivec2 first, glm::ivec2 last) {
    const glm::ivec2 firstTile = first / kTilePixels;
    const glm::ivec2 lastTile = last / kTilePixels;
    for (int row = firstTile.y; row <= lastTile.y; ++row) {
        setBits(&touched_[wordsPerRow_ * row], firstTile.x, lastTile.x);
    }
}

std::int32_t* Sheet::tile(int tileRow, int column) {
    return &pixels_[4 * (layout_.pitchPixels() * tileRow + column) * kTilePixels];
}

void Sheet::settle() {
    const std::size_t pitch = 4 * layout_.pitchPixels();
    for (std::size_t i = 0; i < touched_.size(); ++i) {
        for (std::uint64_t rest = touched_[i]; rest != 0; rest &= rest - 1) {
            const int bit = std::countr_zero(rest);
            const int row = int(i / wordsPerRow_);
            const int column = int(i % wordsPerRow_) * 64 + bit;
            const std::uint64_t full = !isTileZero(tile(row, column), pitch);
            occupied_[i] = (occupied_[i] & ~(std::uint64_t{1} << bit)) | full << bit;
        }
        touched_[i] = 0;
    }
}

void Sheet::clear() {
    const std::size_t pitch = 4 * layout_.pitchPixels();
    settle();
    for (std::size_t i = 0; i < occupied_.size(); ++i) {
        for (std::uint64_t rest = occupied_[i]; rest != 0; rest &= rest - 1) {
            const int column = int(i % wordsPerRow_) * 64 + std::countr_zero(rest);
            clearTile(tile(int(i / wordsPerRow_), column), pitch);
        }
        occupied_[i] = 0;
    }
}

}  // namespace deltasplat
