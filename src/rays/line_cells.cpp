// SPDX-License-Identifier: Apache-2.0
#include "rays/line_cells.h"

#include <glm/common.hpp>

namespace deltasplat {

LineCells::LineCells(const PictureLines& lines, const RayVolume& volume, int side)
    : side_(side), box_(cellsOf(lines.seen())) {
    // To follow a square takes longer than to place so many blocks in a picture.
    constexpr double kBlocksOfCell = 16;
    const glm::dvec2 size = box_.size();
    if (double(volume.blocks.size()) > kBlocksOfCell * size.x * size.y) return;
    mayMeet_.resize(std::size_t(box_.size().x) * std::size_t(box_.size().y));
    for (const CodeBlock& block : volume.blocks) {
        const IndexBox voxels{8 * block.position, 8 * block.position + 7};
        const PixelBox seen = cellsOf(lines.seenOf(voxels));
        const glm::ivec2 low = glm::max(seen.min, box_.min);
        const glm::ivec2 high = glm::min(seen.max, box_.max);
        for (int y = low.y; y < high.y; ++y)
            for (int x = low.x; x < high.x; ++x) mayMeet_[indexOf({x, y})] = true;
    }
}

bool LineCells::anyIn(const PixelBox& lines) const {
    if (mayMeet_.empty()) return true;
    const PixelBox cells = cellsOf(lines);
    const glm::ivec2 low = glm::max(cells.min, box_.min);
    const glm::ivec2 high = glm::min(cells.max, box_.max);
    for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x)
            if (mayMeet_[indexOf({x, y})]) return true;
    return false;
}

PixelBox LineCells::cellsOf(const PixelBox& lines) const {
    return {lines.min / side_, (lines.max + side_ - 1) / side_};
}

std::size_t LineCells::indexOf(glm::ivec2 cell) const {
    const glm::ivec2 place = cell - box_.min;
    return std::size_t(place.y) * std::size_t(box_.size().x) + std::size_t(place.x);
}

}  // namespace deltasplat
