// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_strip.h"

#include <algorithm>
#include <bit>

#include "bit_matrix.h"

namespace deltasplat {
namespace {

ActiveWords allActive() {
    ActiveWords words;
    words.fill(~std::uint64_t{0});
    return words;
}

ActiveWords activeWords(const CodeTree::Leaf& leaf, int sliceAxis) {
    ActiveWords words{};
    const auto& mask = leaf.getValueMask();
    for (int x = 0; x < 8; ++x) {
        const auto word = mask.getWord<std::uint64_t>(x);  // bit 8 * y + z
        const std::uint64_t turned = sliceAxis == 2 ? transposedBits(word) : 0;
        for (int i = 0; i < 8; ++i) {
            if (sliceAxis == 1) words[i] |= (word >> (8 * i) & 0xFF) << (8 * x);  // bit 8 * x + z
            if (sliceAxis == 2) words[i] |= (turned >> (8 * i) & 0xFF) << (8 * x);
        }
        if (sliceAxis == 0) words[x] = word;
    }
    if (sliceAxis == 1) {
        for (std::uint64_t& word : words) word = transposedBits(word);
    }
    return words;
}

}  // namespace

RayStrip::RayStrip(const RayVolume& volume, RayRule rule, glm::ivec2 firstBlock, glm::ivec2 blocks,
                   int rows)
    : volume_(volume),
      rule_(rule),
      firstBlock_(firstBlock),
      columns_(std::size_t(blocks.x) + 2),
      rows_(std::size_t(rows)),
      values_(8 * voxelRows() * pitch()),
      active_(keepsLargest(rule) ? 8 * voxelRows() * columns_ : 0),
      fills_(rows_ * columns_),
      empty_(rows_ * columns_) {}

bool RayStrip::read(int layer, int firstRow, int lastRow) {
    firstRow_ = firstRow;
    std::fill(fills_.begin(), fills_.end(), kNone);
    const std::span<const CodeBlock> blocks = volume_.layer(layer);
    const auto rowOfBlock = [&](const CodeBlock& block) {
        return block.position.y - firstBlock_.y;
    };
    const auto begin = std::partition_point(
        blocks.begin(), blocks.end(), [&](const CodeBlock& b) { return rowOfBlock(b) < firstRow; });
    const auto end = std::partition_point(
        begin, blocks.end(), [&](const CodeBlock& b) { return rowOfBlock(b) <= lastRow; });
    for (auto block = begin; block != end; ++block)
        readBlock(*block, rowOfBlock(*block), block->position.z - firstBlock_.x);
    for (auto block = begin; block != end; ++block)
        emptyAround(rowOfBlock(*block), block->position.z - firstBlock_.x, lastRow);
    return begin != end;
}

BlockPlace RayStrip::placeOf(int row, int column) {
    return {&values_[line(0, 8 * row) * pitch() + 8 * std::size_t(column + 1)],
            voxelRows() * pitch(), pitch()};
}

void RayStrip::readBlock(const CodeBlock& block, int row, int column) {
    empty_[at(row, column)] = false;
    if (block.leaf) return readLeaf(block, row, column);
    fills_[at(row, column)] = kAll;
    if (volume_.sourceValues) {
        volume_.sourceValues(block, placeOf(row, column));
    } else {
        fillBlock(row, column, volume_.valueOf(Code(block.tileSlot - 1)));
    }
    setActive(row, column, allActive());
}

void RayStrip::readLeaf(const CodeBlock& block, int row, int column) {
    const CodeTree::Leaf& leaf = *block.leaf;
    const BlockPlace place = placeOf(row, column);
    if (volume_.sourceValues) {
        volume_.sourceValues(block, place);
    } else {
        readBlockValues(leaf.buffer().data(), volume_.sliceAxis, volume_.values, place);
    }
    const bool dense = leaf.isDense();
    fills_[at(row, column)] = dense ? kAll : kSome;
    const ActiveWords words = dense ? allActive() : activeWords(leaf, volume_.sliceAxis);
    for (std::size_t slice = 0; slice < 8; ++slice) {
        for (std::uint64_t off = ~words[slice]; off != 0; off &= off - 1) {
            const auto bit = std::size_t(std::countr_zero(off));
            place.first[slice * place.sliceStep + bit / 8 * place.rowStep + bit % 8] =
                volume_.empty;
        }
    }
    setActive(row, column, words);
}

void RayStrip::fillBlock(int row, int column, float value) {
    const BlockPlace place = placeOf(row, column);
    for (std::size_t slice = 0; slice < 8; ++slice) {
        for (std::size_t u = 0; u < 8; ++u)
            std::fill_n(place.first + slice * place.sliceStep + u * place.rowStep, 8, value);
    }
}

void RayStrip::setActive(int row, int column, const ActiveWords& words) {
    if (!keepsLargest(rule_)) return;
    for (int slice = 0; slice < 8; ++slice) {
        for (int u = 0; u < 8; ++u) {
            active_[line(slice, 8 * row + u) * columns_ + std::size_t(column + 1)] =
                std::uint8_t(words[std::size_t(slice)] >> (8 * u));
        }
    }
}

// Blocks beside one with voxels are read with it.
void RayStrip::emptyAround(int row, int column, int lastRow) {
    for (int r = std::max(row - 1, firstRow_); r <= std::min(row + 1, lastRow); ++r) {
        for (int c = column - 1; c <= column + 1; ++c) {
            const std::size_t place = at(r, c);
            if (fills_[place] != kNone || empty_[place]) continue;
            fillBlock(r, c, volume_.empty);
            setActive(r, c, {});
            empty_[place] = true;
        }
    }
}

}  // namespace deltasplat
