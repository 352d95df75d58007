// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_volume.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "base/bits.h"
#include "base/parallel.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/delta_grid.h"
#include "volume/leaf_slices.h"
#include "volume/tree_grid.h"

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
    // Hardly more memory than the list of blocks.
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

namespace {

float floatOf(double value) {
    return float(std::clamp(value, -kLargestRayValue, kLargestRayValue));
}

// Exact while the sum of code and offset is exact in floats.
bool isDirect(const CodeBook& book) {
    constexpr double kExactFloats = 1 << 24;
    return book.kind == CodeBook::Kind::kInteger &&
           std::abs(book.offset) + kCodeCount <= kExactFloats;
}

float emptyOf(RayRule rule, float lowest) {
    return rule == RayRule::kMax ? std::min(lowest, 0.0f) : 0.0f;
}

// Fills in the volume's values, and returns the slots of those that matter.
std::vector<Slot> readValues(const Volume& volume, RayRule rule, const ValueMap& map,
                             RayVolume& rays) {
    std::vector<Slot> slots(kSlotCount, kEmptySlot);
    rays.values.direct = isDirect(volume.codeBook()) && map == ValueMap();
    rays.values.offset = float(volume.codeBook().offset);
    if (!rays.values.direct) rays.table.assign(kCodeCount, 0);
    bool any = false;
    for (int code = 0; code < kCodeCount; ++code) {
        const std::uint64_t voxels = volume.histogram()[std::size_t(code)];
        if (voxels == 0) continue;
        const float value = floatOf(map(volume.codeBook().valueOf(Code(code))));
        rays.lowest = any ? std::min(rays.lowest, value) : value;
        rays.highest = any ? std::max(rays.highest, value) : value;
        any = true;
        if (!rays.values.direct) rays.table[std::size_t(code)] = value;
        if (rule == RayRule::kSum && value == 0) continue;
        slots[std::size_t(code) + 1] = code + 1;
        rays.visible += voxels;
    }
    rays.empty = emptyOf(rule, rays.lowest);
    rays.values.table = rays.table.data();
    return slots;
}

template <typename Leaf>
void placeValues(const Leaf& leaf, int sliceAxis, const ValueMap& map, const ValuePlace& place) {
    forLeafVoxels(sliceAxis, [&](const glm::ivec3& at, int n) {
        if (at.x < place.firstSlice || at.x > place.lastSlice) return;
        place.first[std::size_t(at.x) * place.sliceStep + std::size_t(at.y) * place.rowStep +
                    std::size_t(at.z)] = floatOf(map(double(leaf.getValue(openvdb::Index(n)))));
    });
}

void placeValue(float value, const ValuePlace& place) {
    for (std::size_t slice = 0; slice < 8; ++slice) {
        for (std::size_t u = 0; u < 8; ++u)
            std::fill_n(place.first + slice * place.sliceStep + u * place.rowStep, 8, value);
    }
}

// Lets rays read the source's own values.
void readSource(const Volume& volume, RayRule rule, const ValueMap& map, std::vector<Slot>& slots,
                RayVolume& rays) {
    const auto [low, high] = std::minmax({map(volume.valueMin()), map(volume.valueMax())});
    rays.lowest = floatOf(low);
    rays.highest = floatOf(high);
    rays.empty = emptyOf(rule, rays.lowest);
    // A code of value 0 may stand for other source values.
    for (std::size_t code = 0; code < volume.histogram().size(); ++code)
        slots[code + 1] = volume.histogram()[code] > 0 ? Slot(code + 1) : kEmptySlot;
    volume.source()->grid.apply<ScalarTrees>([&](const auto& tree) {
        rays.sourceValues = [&tree, map](const CodeBlock& block, int axis,
                                         const ValuePlace& place) {
            const openvdb::Coord origin = blockOrigin(block.position, 0);
            const auto* const leaf = tree.probeConstLeaf(origin);
            leaf ? placeValues(*leaf, axis, map, place)
                 : placeValue(floatOf(map(double(tree.getValue(origin)))), place);
        };
    });
}

// Drops uniform blocks of zero, which add nothing to a sum.
void dropZeros(const Volume& volume, const ValueMap& map, std::vector<CodeBlock>& blocks) {
    volume.source()->grid.apply<ScalarTrees>([&](const auto& tree) {
        std::erase_if(blocks, [&](const CodeBlock& block) {
            if (block.leaf) return false;
            const openvdb::Coord origin = blockOrigin(block.position, 0);
            return !tree.probeConstLeaf(origin) && map(double(tree.getValue(origin))) == 0;
        });
    });
}

// A word per slice of a block: bit 8 * u + v is set where the voxel is active.
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

// Largest value of occurring codes between two codes.
class CodeTops {
  public:
    CodeTops(const Volume& volume, const RayVolume& rays)
        : upTo_(kCodeCount, kNothing), from_(kCodeCount, kNothing) {
        const auto topOf = [&](std::size_t code) {
            return volume.histogram()[code] > 0 ? rays.valueOf(Code(code)) : kNothing;
        };
        float top = kNothing;
        for (std::size_t code = 0; code < kCodeCount; ++code)
            upTo_[code] = top = std::max(top, topOf(code));
        top = kNothing;
        for (std::size_t code = kCodeCount; code-- > 0;)
            from_[code] = top = std::max(top, topOf(code));
    }
    float topOf(Code lowest, Code highest) const { return std::min(from_[lowest], upTo_[highest]); }

  private:
    std::vector<float> upTo_, from_;
};

float topOfSource(const RayVolume& rays, const CodeBlock& block) {
    std::array<float, 512> values, active;
    readBlock(rays, block, 0, {0, 7}, values.data(), active.data());
    float top = kNothing;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (active[i] > 0) top = std::max(top, values[i]);
    return top;
}

void findTops(const Volume& volume, RayRule rule, RayVolume& rays) {
    std::vector<float> tops(rays.blocks.size(), 0.0f);
    if (rays.sourceValues && isExtreme(rule)) {
        parallelFor(tops.size(),
                    [&](std::size_t i) { tops[i] = topOfSource(rays, rays.blocks[i]); });
    } else if (isExtreme(rule)) {
        const CodeTops codes(volume, rays);
        for (std::size_t i = 0; i < tops.size(); ++i) {
            const CodeBlock& block = rays.blocks[i];
            tops[i] = block.leaf ? codes.topOf(block.lowest, block.highest)
                                 : rays.valueOf(Code(block.tileSlot - 1));
        }
    }
    // Inactive places read `empty`.
    if (rule == RayRule::kMax)
        for (float& top : tops) top = std::max(top, rays.empty);
    rays.tops = TopGrid(rays.blocks, tops);
}

}  // namespace

LayerNumbers layersOf(std::size_t count,
                      const std::function<const CodeBlock&(std::size_t)>& blockAt) {
    LayerNumbers all;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<int>& layers = all[std::size_t(axis)];
        for (std::size_t i = 0; i < count; ++i) {
            const int number = blockAt(i).position[axis];
            if (layers.empty() || layers.back() != number) layers.push_back(number);
        }
        std::sort(layers.begin(), layers.end());
        layers.erase(std::unique(layers.begin(), layers.end()), layers.end());
    }
    return all;
}

RayVolume makeRayVolume(const Volume& volume, RayRule rule, const ValueMap& map) {
    RayVolume rays;
    rays.box = volume.box();
    std::vector<Slot> slots = readValues(volume, rule, map, rays);
    const bool fromSource = volume.source() && !volume.codeBook().isExact() && !isOfCodes(volume);
    if (fromSource) readSource(volume, rule, map, slots, rays);
    rays.blocks = BlockReader(*volume.codes(), nullptr, 0, slots).takeBlocks();
    if (fromSource && rule == RayRule::kSum) dropZeros(volume, map, rays.blocks);
    rays.layers = layersOf(rays.blocks.size(),
                           [&](std::size_t i) -> const CodeBlock& { return rays.blocks[i]; });
    findTops(volume, rule, rays);
    return rays;
}

void readBlock(const RayVolume& volume, const CodeBlock& block, int axis, glm::ivec2 slices,
               float* values, float* active) {
    const ValuePlace place{values, 64, 8, slices.x, slices.y};
    const std::ptrdiff_t first = 64 * std::ptrdiff_t{slices.x};
    const std::ptrdiff_t count = 64 * (std::ptrdiff_t{slices.y} - slices.x + 1);
    if (volume.sourceValues) {
        volume.sourceValues(block, axis, place);
    } else if (block.leaf) {
        readBlockValues(block.leaf->buffer().data(), axis, volume.values, place);
    } else {
        std::fill_n(values + first, count, volume.valueOf(Code(block.tileSlot - 1)));
    }
    if (active) std::fill_n(active + first, count, 1.0f);
    if (!block.leaf || block.leaf->isDense()) return;
    const ActiveWords words = activeWords(*block.leaf, axis);
    for (auto slice = std::size_t(slices.x); slice <= std::size_t(slices.y); ++slice) {
        for (std::uint64_t off = ~words[slice]; off != 0; off &= off - 1) {
            const std::size_t at = 64 * slice + std::size_t(std::countr_zero(off));
            values[at] = volume.empty;
            if (active) active[at] = 0;
        }
    }
}

}  // namespace deltasplat
