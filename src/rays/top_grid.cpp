// SPDX-License-Identifier: Apache-2.0
#include "rays/top_grid.h"

#include <algorithm>
#include <glm/common.hpp>
#include <limits>

namespace deltasplat {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();

std::size_t cellsOf(const glm::ivec3& size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

}  // namespace

TopGrid::TopGrid(std::span<const CodeBlock> blocks, std::span<const float> tops) {
    if (blocks.empty()) return;
    glm::ivec3 low = blocks.front().position, high = low;
    for (const CodeBlock& block : blocks) {
        low = glm::min(low, block.position);
        high = glm::max(high, block.position);
    }
    // Hardly more memory than the list of blocks takes.
    const double most = 4096 + 8.0 * double(blocks.size());
    for (shift_ = 0;; ++shift_) {
        first_ = low >> shift_;
        size_ = (high >> shift_) - first_ + 1;
        if (double(size_.x) * size_.y * size_.z <= most) break;
    }
    tops_.assign(cellsOf(size_), kNothing);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const glm::ivec3 cell = (blocks[i].position >> shift_) - first_;
        float& top = tops_[cellsOf({1, size_.x, size_.y}) * std::size_t(cell.z) +
                           std::size_t(size_.x * cell.y + cell.x)];
        top = std::max(top, tops[i]);
    }
}

float TopGrid::topBetween(glm::ivec3 low, glm::ivec3 high) const {
    low = glm::max((low >> shift_) - first_, 0);
    high = glm::min((high >> shift_) - first_, size_ - 1);
    float top = kNothing;
    for (int z = low.z; z <= high.z; ++z) {
        for (int y = low.y; y <= high.y; ++y) {
            const float* row = tops_.data() + cellsOf({1, size_.x, size_.y}) * std::size_t(z) +
                               std::size_t(size_.x) * std::size_t(y);
            for (int x = low.x; x <= high.x; ++x) top = std::max(top, row[x]);
        }
    }
    return top;
}

}  // namespace deltasplat
