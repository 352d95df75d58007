// SPDX-License-Identifier: Apache-2.0
#include "rays/patch_reader.h"

#include <algorithm>
#include <glm/vector_relational.hpp>
#include <limits>
#include <tuple>

namespace deltasplat {
namespace {

// Vectors of four are read from any value on.
constexpr std::size_t kSpare = 4;

// Positions [first, last] of a box along one axis in voxels [8 * block, 8 * block + 7].
struct Overlap {
    int first;
    int last;

    std::size_t count() const { return std::size_t(last - first) + 1; }
    Overlap(const RayAxes& axes, const PatchBox& box, int i, int block) {
        const int a = axes.sign[i] * (8 * block - axes.first[i]);
        const int b = axes.sign[i] * (8 * block + 7 - axes.first[i]);
        first = std::max(std::min(a, b), box.first[i]);
        last = std::min(std::max(a, b), box.first[i] + box.size[i] - 1);
    }
};

// Intersection of a block and a box.
struct Shared {
    Overlap s, u, v;

    Shared(const RayAxes& axes, const PatchBox& box, const CodeBlock& block)
        : s(axes, box, 0, block.position[axes.order[0]]),
          u(axes, box, 1, block.position[axes.order[1]]),
          v(axes, box, 2, block.position[axes.order[2]]) {}
    std::size_t voxels() const { return s.count() * u.count() * v.count(); }
};

// Copies values forwards or backwards, mostly eight.
void copyRow(const float* from, std::ptrdiff_t count, bool isForward, float* to) {
    if (count == 8 && isForward) {
        std::copy_n(from, 8, to);
    } else if (count == 8) {
        std::reverse_copy(from, from + 8, to);
    } else if (isForward) {
        std::copy_n(from, count, to);
    } else {
        std::reverse_copy(from, from + count, to);
    }
}

bool isBefore(const CodeBlock& block, const glm::ivec3& position) {
    return std::tie(block.position.y, block.position.z, block.position.x) <
           std::tie(position.y, position.z, position.x);
}

}  // namespace

bool PatchReader::find(const RayAxes& axes, const PatchBox& box) {
    glm::ivec3 low(0), high(0);
    for (int i = 0; i < 3; ++i) {
        const int a = axes.voxelAt(i, box.first[i]);
        const int b = axes.voxelAt(i, box.first[i] + box.size[i] - 1);
        low[axes.order[i]] = std::min(a, b) >> 3;
        high[axes.order[i]] = std::max(a, b) >> 3;
    }
    found_.clear();
    const std::vector<CodeBlock>& blocks = volume_.blocks;
    // Few blocks are all tested, however large the part.
    if (double(high.y - low.y + 1) * (high.z - low.z + 1) > double(blocks.size())) {
        for (const CodeBlock& block : blocks) {
            if (glm::all(glm::greaterThanEqual(block.position, low)) &&
                glm::all(glm::lessThanEqual(block.position, high)))
                found_.push_back(&block);
        }
        return !found_.empty();
    }
    auto at = blocks.begin();
    for (int y = low.y; y <= high.y; ++y) {
        for (int z = low.z; z <= high.z; ++z) {
            at = std::lower_bound(at, blocks.end(), glm::ivec3(low.x, y, z), isBefore);
            for (; at != blocks.end() && at->position.y == y && at->position.z == z &&
                   at->position.x <= high.x;
                 ++at)
                found_.push_back(&*at);
        }
    }
    return !found_.empty();
}

const RayPatch& PatchReader::read(const RayAxes& axes, const PatchBox& box) {
    const std::size_t slice = std::size_t(box.size.y) * std::size_t(box.size.z);
    const std::size_t count = slice * std::size_t(box.size.x);
    std::size_t active = 0;
    for (const CodeBlock* block : found_)
        if (!block->leaf || block->leaf->isDense()) active += Shared(axes, box, *block).voxels();
    const bool isWhole = active == count;
    const bool asksActive = rule_ != RayRule::kSum && !isWhole;
    if (isWhole) {
        values_.resize(count + kSpare);
    } else {
        values_.assign(count + kSpare, volume_.empty);
    }
    if (asksActive) active_.assign(count + kSpare, 0.0f);
    for (const CodeBlock* block : found_) addBlock(axes, box, *block, asksActive);
    patch_ = RayPatch();
    patch_.values = values_.data();
    patch_.active = asksActive ? active_.data() : nullptr;
    patch_.sliceStep = std::ptrdiff_t(slice);
    patch_.slices = box.size.x;
    patch_.sizeU = box.size.y;
    patch_.sizeV = box.size.z;
    patch_.leavesOut = rule_ == RayRule::kMaxActive && asksActive;
    if (isExtreme(rule_)) findTops(box);
    return patch_;
}

// Maximum of each 6x6 values, which any of 4x4 lines may read, then of two slices.
void PatchReader::findTops(const PatchBox& box) {
    constexpr int kRead = kTopCell + 2;
    patch_.topsU = (box.size.y + kTopCell - 1) / kTopCell;
    patch_.topsV = (box.size.z + kTopCell - 1) / kTopCell;
    const std::size_t cells = std::size_t(patch_.topsU) * std::size_t(patch_.topsV);
    sliceTops_.resize(cells * std::size_t(box.size.x));
    rowTops_.resize(std::size_t(box.size.z));
    const bool leavesOut = patch_.leavesOut;
    float* out = sliceTops_.data();
    for (int slice = 0; slice < box.size.x; ++slice) {
        for (int u = 0; u < box.size.y; u += kTopCell) {
            std::fill(rowTops_.begin(), rowTops_.end(), -std::numeric_limits<float>::infinity());
            for (int row = u; row < std::min(u + kRead, box.size.y); ++row) {
                const std::size_t first =
                    (std::size_t(slice) * std::size_t(box.size.y) + std::size_t(row)) *
                    std::size_t(box.size.z);
                for (std::size_t v = 0; v < rowTops_.size(); ++v) {
                    // Without other active values, inactive ones are 0.
                    const float value = leavesOut && active_[first + v] == 0
                                            ? -std::numeric_limits<float>::infinity()
                                            : values_[first + v];
                    rowTops_[v] = std::max(rowTops_[v], value);
                }
            }
            for (int v = 0; v < box.size.z; v += kTopCell)
                *out++ = *std::max_element(rowTops_.begin() + v,
                                           rowTops_.begin() + std::min(v + kRead, box.size.z));
        }
    }
    tops_.resize(cells * std::size_t(std::max(box.size.x - 1, 0)));
    for (std::size_t i = 0; i < tops_.size(); ++i)
        tops_[i] = std::max(sliceTops_[i], sliceTops_[i + cells]);
    patch_.tops = tops_.data();
}

void PatchReader::addBlock(const RayAxes& axes, const PatchBox& box, const CodeBlock& block,
                           bool asksActive) {
    const auto [s, u, v] = Shared(axes, box, block);
    const auto inBlock = [&](int i, int at) {
        return std::ptrdiff_t(axes.voxelAt(i, at) - 8 * block.position[axes.order[i]]);
    };
    const auto [first, last] = std::minmax({inBlock(0, s.first), inBlock(0, s.last)});
    readBlock(volume_, block, axes.order[0], {first, last}, block_.data(),
              asksActive ? blockActive_.data() : nullptr);
    const std::ptrdiff_t columns = v.last - v.first + 1;
    const bool isForward = axes.sign[2] > 0;
    const std::ptrdiff_t firstColumn = inBlock(2, isForward ? v.first : v.last);
    for (int slice = s.first; slice <= s.last; ++slice) {
        for (int row = u.first; row <= u.last; ++row) {
            const std::ptrdiff_t from = 64 * inBlock(0, slice) + 8 * inBlock(1, row) + firstColumn;
            const glm::ivec3 to = glm::ivec3(slice, row, v.first) - box.first;
            const std::ptrdiff_t out =
                (std::ptrdiff_t{to.x} * box.size.y + to.y) * box.size.z + to.z;
            copyRow(block_.data() + from, columns, isForward, values_.data() + out);
            if (asksActive)
                copyRow(blockActive_.data() + from, columns, isForward, active_.data() + out);
        }
    }
}

}  // namespace deltasplat
