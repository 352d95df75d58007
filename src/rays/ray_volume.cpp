// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_volume.h"

#include <algorithm>
#include <cmath>

#include "delta/block_windows.h"
#include "ingest/codes/leaf_slices.h"
#include "ingest/delta/delta_origin.h"
#include "ingest/grids/source_grid.h"

namespace deltasplat {
namespace {

float floatOf(double value) {
    return float(std::clamp(value, -kLargestRayValue, kLargestRayValue));
}

// Code and offset are added as floats: exact as long as their sum is.
bool isDirect(const CodeBook& book) {
    constexpr double kExactFloats = 1 << 24;
    return book.kind == CodeBook::Kind::kInteger &&
           std::abs(book.offset) + kCodeCount <= kExactFloats;
}

float emptyOf(RayRule rule, float lowest) {
    return rule == RayRule::kMax ? std::min(lowest, 0.0f) : 0.0f;
}

// Fills in what values the volume has, and returns the slots of those that matter.
std::vector<Slot> readValues(const Volume& volume, RayRule rule, const ValueMap& map,
                             RayVolume& rays) {
    std::vector<Slot> slots(kSlotCount, kEmptySlot);
    rays.values.direct = isDirect(volume.codeBook) && map == ValueMap();
    rays.values.offset = float(volume.codeBook.offset);
    if (!rays.values.direct) rays.table.assign(kCodeCount, 0);
    bool any = false;
    for (int code = 0; code < kCodeCount; ++code) {
        const std::uint64_t voxels = volume.histogram[std::size_t(code)];
        if (voxels == 0) continue;
        const float value = floatOf(map(volume.codeBook.valueOf(Code(code))));
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
void placeValues(const Leaf& leaf, int sliceAxis, const ValueMap& map, const BlockPlace& place) {
    forLeafVoxels(sliceAxis, [&](const glm::ivec3& at, int n) {
        place.first[std::size_t(at.x) * place.sliceStep + std::size_t(at.y) * place.rowStep +
                    std::size_t(at.z)] = floatOf(map(double(leaf.getValue(openvdb::Index(n)))));
    });
}

void placeValue(float value, const BlockPlace& place) {
    for (std::size_t slice = 0; slice < 8; ++slice) {
        for (std::size_t u = 0; u < 8; ++u)
            std::fill_n(place.first + slice * place.sliceStep + u * place.rowStep, 8, value);
    }
}

// Lets rays read the source's own values.
void readSource(const Volume& volume, RayRule rule, const ValueMap& map, std::vector<Slot>& slots,
                RayVolume& rays) {
    const auto [low, high] = std::minmax({map(volume.valueMin), map(volume.valueMax)});
    rays.lowest = floatOf(low);
    rays.highest = floatOf(high);
    rays.empty = emptyOf(rule, rays.lowest);
    // A code of value 0 may stand for something else as well.
    for (std::size_t code = 0; code < volume.histogram.size(); ++code)
        slots[code + 1] = volume.histogram[code] > 0 ? Slot(code + 1) : kEmptySlot;
    volume.source->grid.apply<ScalarTrees>([&](const auto& tree) {
        rays.sourceValues = [&tree, map](const CodeBlock& block, int axis,
                                         const BlockPlace& place) {
            const openvdb::Coord origin = blockOrigin(block.position, 0);
            const auto* const leaf = tree.probeConstLeaf(origin);
            leaf ? placeValues(*leaf, axis, map, place)
                 : placeValue(floatOf(map(double(tree.getValue(origin)))), place);
        };
    });
}

// Takes out uniform blocks of nothing: of a sum they are no part.
void dropZeros(const Volume& volume, const ValueMap& map, std::vector<CodeBlock>& blocks) {
    volume.source->grid.apply<ScalarTrees>([&](const auto& tree) {
        std::erase_if(blocks, [&](const CodeBlock& block) {
            if (block.leaf) return false;
            const openvdb::Coord origin = blockOrigin(block.position, 0);
            return !tree.probeConstLeaf(origin) && map(double(tree.getValue(origin))) == 0;
        });
    });
}

// Lists at which numbers of blocks there are any, along each axis.
void listLayers(RayVolume& rays) {
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<int>& layers = rays.layers[std::size_t(axis)];
        for (const CodeBlock& block : rays.blocks) {
            const int number = block.position[axis];
            if (layers.empty() || layers.back() != number) layers.push_back(number);
        }
        std::sort(layers.begin(), layers.end());
        layers.erase(std::unique(layers.begin(), layers.end()), layers.end());
    }
}

}  // namespace

RayVolume makeRayVolume(const Volume& volume, RayRule rule, const ValueMap& map) {
    RayVolume rays;
    rays.box = volume.box;
    std::vector<Slot> slots = readValues(volume, rule, map, rays);
    const bool fromSource = volume.source && !volume.codeBook.isExact() && !isOfCodes(volume);
    if (fromSource) readSource(volume, rule, map, slots, rays);
    rays.blocks = BlockReader(*volume.codes, nullptr, 0, slots).takeBlocks();
    if (fromSource && rule == RayRule::kSum) dropZeros(volume, map, rays.blocks);
    listLayers(rays);
    return rays;
}

}  // namespace deltasplat
