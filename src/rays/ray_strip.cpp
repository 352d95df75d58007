// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_strip.h"

#include <algorithm>

namespace deltasplat {
namespace {

constexpr ActiveWords kAllActive = [] {
    ActiveWords words{};
    words.fill(~std::uint64_t{0});
    return words;
}();

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
    const ActiveWords words = readActiveValues(volume_, block, placeOf(row, column));
    fills_[at(row, column)] = words == kAllActive ? kAll : kSome;
    setActive(row, column, words);
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
            fillBlock(volume_.empty, placeOf(r, c));
            setActive(r, c, {});
            empty_[place] = true;
        }
    }
}

}  // namespace deltasplat
