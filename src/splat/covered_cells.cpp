// SPDX-License-Identifier: Apache-2.0
// Based on: Franklin Crow, "Summed-Area Tables for Texture Mapping", 1984.
#include "splat/covered_cells.h"

#include <algorithm>
#include <glm/common.hpp>

namespace deltasplat {

CoveredCells::CoveredCells(const PlaneBox& box) : box_(box) {
    if (!box.empty()) size_ = (box.size() + (kCellPixels - 1)) / kCellPixels;
    covered_.resize(std::size_t(size_.x) * std::size_t(size_.y));
    open_.resize(std::size_t(size_.x + 1) * std::size_t(size_.y + 1));
    settle();
}

PlaneBox CoveredCells::pixelsOf(glm::ivec2 cell) const {
    const glm::ivec2 first = box_.min + kCellPixels * cell;
    return {first, glm::min(first + kCellPixels, box_.max)};
}

glm::ivec2 CoveredCells::cellsOf(int axis, glm::ivec2 pixels) const {
    const auto placeOf = [&](int pixel) {
        return std::clamp(pixel, box_.min[axis], box_.max[axis]) - box_.min[axis];
    };
    return cellsOf({placeOf(pixels.x), placeOf(pixels.y)});
}

void CoveredCells::settle() {
    const std::size_t width = std::size_t(size_.x) + 1;
    for (int y = 0; y < size_.y; ++y) {
        std::uint32_t ofRow = 0;
        for (int x = 0; x < size_.x; ++x) {
            ofRow += isCovered({x, y}) ? 0 : 1;
            const std::size_t above = width * std::size_t(y) + std::size_t(x) + 1;
            open_[above + width] = open_[above] + ofRow;
        }
    }
}

}  // namespace deltasplat
