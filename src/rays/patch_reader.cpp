// SPDX-License-Identifier: Apache-2.0
#include "rays/patch_reader.h"

#include <algorithm>
#include <bit>
#include <glm/vector_relational.hpp>
#include <limits>
#include <tuple>

#include "bit_matrix.h"

namespace deltasplat {
namespace {

// Vectors of four are read from any place on.
constexpr std::size_t kSpare = 4;

// A word for each slice of a block: bit 8 * u + v is set where the voxel is active.
using ActiveWords = std::array<std::uint64_t, 8>;

ActiveWords activeWords(const CodeTree::Leaf& leaf, int sliceAxis) {
    ActiveWords words{};
    const auto& mask = leaf.getValueMask();
    for (int x = 0; x < 8; ++x) {
        const auto word = mask.getWord<std::uint64_t>(openvdb::Index(x));  // bit 8 * y + z
        const std::uint64_t turned = sliceAxis == 2 ? transposedBits(word) : 0;
        for (std::size_t i = 0; i < 8; ++i) {
            if (sliceAxis == 1) words[i] |= (word >> (8 * i) & 0xFF) << (8 * x);  // bit 8 * x + z
            if (sliceAxis == 2) words[i] |= (turned >> (8 * i) & 0xFF) << (8 * x);
        }
        if (sliceAxis == 0) words[std::size_t(x)] = word;
    }
    if (sliceAxis == 1) {
        for (std::uint64_t& word : words) word = transposedBits(word);
    }
    return words;
}

// Reads a block in the order of an axis.
void readBlock(const RayVolume& volume, const CodeBlock& block, int axis, float* values,
               float* active) {
    const BlockPlace place{values, 64, 8};
    if (volume.sourceValues) {
        volume.sourceValues(block, axis, place);
    } else if (block.leaf) {
        readBlockValues(block.leaf->buffer().data(), axis, volume.values, place);
    } else {
        std::fill_n(values, 512, volume.valueOf(Code(block.tileSlot - 1)));
    }
    if (active) std::fill_n(active, 512, 1.0f);
    if (!block.leaf || block.leaf->isDense()) return;
    const ActiveWords words = activeWords(*block.leaf, axis);
    for (std::size_t slice = 0; slice < 8; ++slice) {
        for (std::uint64_t off = ~words[slice]; off != 0; off &= off - 1) {
            const std::size_t at = 64 * slice + std::size_t(std::countr_zero(off));
            values[at] = volume.empty;
            if (active) active[at] = 0;
        }
    }
}

// Positions [first, last] of a box along one axis that voxels [8 * block, 8 * block + 7] have.
struct Overlap {
    int first;
    int last;

    Overlap(const RayAxes& axes, const PatchBox& box, int i, int block) {
        const int a = axes.sign[i] * (8 * block - axes.first[i]);
        const int b = axes.sign[i] * (8 * block + 7 - axes.first[i]);
        first = std::max(std::min(a, b), box.first[i]);
        last = std::min(std::max(a, b), box.first[i] + box.size[i] - 1);
    }
};

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
    // Of few blocks each is looked at, however large the part.
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
    const bool asksActive = rule_ != RayRule::kSum;
    const std::size_t slice = std::size_t(box.size.y) * std::size_t(box.size.z);
    const std::size_t count = slice * std::size_t(box.size.x) + kSpare;
    values_.assign(count, volume_.empty);
    if (asksActive) active_.assign(count, 0.0f);
    for (const CodeBlock* block : found_) addBlock(axes, box, *block);
    patch_ = RayPatch();
    patch_.values = values_.data();
    patch_.active = asksActive ? active_.data() : nullptr;
    patch_.sliceStep = std::ptrdiff_t(slice);
    patch_.slices = box.size.x;
    patch_.sizeU = box.size.y;
    patch_.sizeV = box.size.z;
    patch_.leavesOut = rule_ == RayRule::kMaxActive;
    if (rule_ == RayRule::kMax || rule_ == RayRule::kMaxActive) findTops(box);
    return patch_;
}

// The largest of each 6x6 values (what may be read from any of 4x4 on), then of two slices.
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
                    // Where nothing else counts, values that are not there are 0.
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

void PatchReader::addBlock(const RayAxes& axes, const PatchBox& box, const CodeBlock& block) {
    const bool asksActive = rule_ != RayRule::kSum;
    readBlock(volume_, block, axes.order[0], block_.data(),
              asksActive ? blockActive_.data() : nullptr);
    const glm::ivec3 position(block.position[axes.order[0]], block.position[axes.order[1]],
                              block.position[axes.order[2]]);
    const Overlap s(axes, box, 0, position.x);
    const Overlap u(axes, box, 1, position.y);
    const Overlap v(axes, box, 2, position.z);
    const auto inBlock = [&](int i, int at) {
        return std::ptrdiff_t(axes.voxelAt(i, at) - 8 * position[i]);
    };
    for (int slice = s.first; slice <= s.last; ++slice) {
        for (int row = u.first; row <= u.last; ++row) {
            const std::ptrdiff_t from = 64 * inBlock(0, slice) + 8 * inBlock(1, row);
            const glm::ivec3 to = glm::ivec3(slice, row, v.first) - box.first;
            const std::size_t out =
                (std::size_t(to.x) * std::size_t(box.size.y) + std::size_t(to.y)) *
                    std::size_t(box.size.z) +
                std::size_t(to.z);
            for (int column = v.first; column <= v.last; ++column) {
                const auto in = std::size_t(from + inBlock(2, column));
                const std::size_t place = out + std::size_t(column - v.first);
                values_[place] = block_[in];
                if (asksActive) active_[place] = blockActive_[in];
            }
        }
    }
}

}  // namespace deltasplat
