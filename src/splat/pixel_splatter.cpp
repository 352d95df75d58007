// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9, for footprints that do not overlap: what a voxel was is written over.
#include "splat/pixel_splatter.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/bits.h"
#include "volume/block_kernels.h"

namespace deltasplat {
namespace {

template <typename Value>
constexpr std::size_t kNumbersOf = sizeof(Value) / sizeof(std::int32_t);

}  // namespace

double PixelSplatter::bytes(const SplatInput& input, const SheetLayout& layout) {
    // Which slice blocks show, which of them do, twice, and what waits.
    const double ofBlock = sizeof(int) + 4 * sizeof(glm::ivec2) + SliceBlocks::kBytesOfBlock;
    const double ofClass = sizeof(std::int32_t) * layout.channels;
    return ofBlock * double(layout.blocks.x) * layout.blocks.y +
           ofClass * double(input.colors.table().size());
}

PixelSplatter::PixelSplatter(const SplatInput& input, const SheetLayout& largest, Sheet& sheet,
                             DigitPlace digit, bool withLow)
    : blocks_(input, largest, digit, withLow),
      sheet_(sheet),
      one_(input.footprint.weights.front()),
      slices_(blocks_.count()) {
    const ClassTable& table = input.colors.table();
    const std::vector<ClassTable::Color>& high = digit.of(table).colors;
    const ClassTable::Color* low =
        withLow ? DigitPlace{digit.plane, true}.of(table).colors.data() : nullptr;
    largest.channels == 4 ? pixels_.reserve(high.size()) : opacities_.reserve(high.size());
    for (std::size_t i = 0; i < high.size(); ++i) {
        const Pixel pixel = pixelOf(high[i], low ? low + i : nullptr);
        if (largest.channels == 4) {
            pixels_.push_back(pixel);
        } else {
            opacities_.push_back(pixel[3]);
        }
    }
}

// What stamping both digits and adding them up gives (Sheet::addDigits).
PixelSplatter::Pixel PixelSplatter::pixelOf(const ClassTable::Color& high,
                                            const ClassTable::Color* low) const {
    constexpr int kBits = ClassTable::kDigitBits;
    Pixel pixel;
    for (std::size_t c = 0; c < 4; ++c) {
        const std::int32_t fine = low ? (one_ * (*low)[c] + (1 << (kBits - 1))) >> kBits : 0;
        pixel[c] = one_ * high[c] + fine;
    }
    return pixel;
}

void PixelSplatter::splat(int slice, bool whole, const NeededPixels& needed) {
    if (whole) {
        splatWhole(slice, needed);
    } else {
        splatChanges(slice, needed);
    }
}

void PixelSplatter::splatChanges(int slice, const NeededPixels& needed) {
    blocks_.forChanges(
        slice, needed, [&](glm::ivec2 block, std::uint64_t changed, const SeenWord& word) {
            const Sheet::Tile tile = sheet_.tileOf(block);
            tile.full = rowsWithAny(word.visible);
            const unsigned rows = rowsWithAny(changed);
            const bool byVoxel = std::popcount(changed) <= kVoxelsOfRow * std::popcount(rows);
            withValues(word, [&](const auto* values) {
                if (byVoxel) {
                    writeVoxels(tile.pixels, changed, word.classes, values);
                } else {
                    writeRows(tile.pixels, rows, word.classes, values);
                }
            });
        });
}

// Rows that the slice before showed are written over, or taken away with their block. Those that
// nobody reads stay as they are: at the edges of parts, most of a block.
void PixelSplatter::splatWhole(int slice, const NeededPixels& needed) {
    before_.swap(shownBlocks_);
    shownBlocks_.clear();
    blocks_.forWhole(
        slice, needed, [&](glm::ivec2 block, std::uint64_t voxels, const SeenWord& word) {
            const Sheet::Tile tile = sheet_.tileOf(block);
            const unsigned read = sheet_.rowsOfTile(block, needed.firstRow, needed.lastRow);
            const unsigned rows = (rowsWithAny(voxels) | tile.full) & read;
            if (rows != 0) {
                withValues(word, [&](const auto* values) {
                    writeRows(tile.pixels, rows, word.classes, values);
                });
            }
            tile.full = std::uint8_t((rowsWithAny(word.visible) & read) | (tile.full & ~read));
            slices_[blocks_.placeOf(block)] = slice;
            shownBlocks_.push_back(block);
        });
    for (const glm::ivec2 block : before_) {
        if (slices_[blocks_.placeOf(block)] != slice) sheet_.clear(sheet_.tileOf(block));
    }
}

void PixelSplatter::clear() {
    blocks_.clear();
    sheet_.clear();
    shownBlocks_.clear();
}

// Calls use(values) with the pixels, or opacities, of a word's classes.
template <typename Use>
void PixelSplatter::withValues(const SeenWord& word, const Use& use) {
    if (word.hasOwn) {
        // Which are not all the same, and have a low digit.
        for (std::size_t n = 0; n < own_.size(); ++n)
            own_[n] = pixelOf(word.colors[n], word.lowColors + n);
        use(own_.data());
    } else if (sheet_.layout().channels == 4) {
        use(pixels_.data());
    } else {
        use(opacities_.data());
    }
}

template <typename Value>
void PixelSplatter::writeVoxels(std::int32_t* tile, std::uint64_t voxels, const ClassIndex* classes,
                                const Value* values) const {
    const std::size_t pitch = sheet_.pitch();
    for (; voxels != 0; voxels &= voxels - 1) {
        const auto n = std::size_t(std::countr_zero(voxels));
        std::memcpy(tile + pitch * (n >> 3) + kNumbersOf<Value> * (n & 7), &values[classes[n]],
                    sizeof(Value));
    }
}

template <typename Value>
void PixelSplatter::writeRows(std::int32_t* tile, unsigned rows, const ClassIndex* classes,
                              const Value* values) const {
    const std::size_t pitch = sheet_.pitch();
    for (; rows != 0; rows &= rows - 1) {
        const auto u = std::size_t(std::countr_zero(rows));
        std::int32_t* const row = tile + pitch * u;
        for (std::size_t v = 0; v < 8; ++v)
            std::memcpy(row + kNumbersOf<Value> * v, &values[classes[8 * u + v]], sizeof(Value));
    }
}

}  // namespace deltasplat
