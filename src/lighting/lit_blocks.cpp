// SPDX-License-Identifier: Apache-2.0
#include "lighting/lit_blocks.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory_resource>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "volume/leaf_slices.h"

namespace deltasplat {

LitBlocks::LitBlocks(const Volume& volume, const ClassTable& classes)
    : classOfSlot_(classes.classOfSlot()) {
    // Along x, positions are (x, y, z).
    const BlockReader reader(*volume.codes(), nullptr, 0, classOfSlot_);
    // A node of the map and its place in the table.
    constexpr double kMapBytes = 48;
    requireMemory("list of lit blocks",
                  (double(sizeof(Block)) + kMapBytes) * double(reader.blocks().size()));
    blocks_.reserve(reader.blocks().size());
    numbers_.reserve(reader.blocks().size());
    for (const CodeBlock& block : reader.blocks()) {
        numbers_.emplace(block.position, std::uint32_t(blocks_.size()));
        blocks_.push_back({block.position, block.leaf, block.tileSlot});
    }
}

std::int64_t LitBlocks::find(const glm::ivec3& position) const {
    const auto found = numbers_.find(position);
    return found == numbers_.end() ? -1 : std::int64_t(found->second);
}

LitBlocks::Along LitBlocks::along(int sliceAxis) const {
    const double bytes = 512 * sizeof(std::uint16_t) + sizeof(Along::Place);
    requireMemory("blocks as light comes upon them", bytes * double(size()));
    Along along;
    along.sliceAxis = sliceAxis;
    std::vector<Along::Place> places;
    const auto placeOf = [&](std::size_t number) {
        const glm::ivec3 place = 8 * toSliceOrder(blocks_[number].position, sliceAxis);
        return std::array{place.x, place.y, place.z};
    };
    for (std::size_t number = 0; number < size(); ++number) {
        places.push_back({number, {placeOf(number)[1], placeOf(number)[2]}});
    }
    std::sort(places.begin(), places.end(), [&](const Along::Place& a, const Along::Place& b) {
        return placeOf(a.number) < placeOf(b.number);
    });
    for (const Along::Place& place : places) along.add(placeOf(place.number)[0], place);
    auto classes = std::make_shared<UnclearedArray<std::uint16_t>>(
        512 * size(), *std::pmr::get_default_resource());
    if (size() != 0) readClasses(sliceAxis, &(*classes)[0]);
    along.classes = std::move(classes);
    return along;
}

void LitBlocks::Along::add(int firstSlice, const Place& place) {
    const std::size_t number = order.size();
    low = number == 0 ? place.first : glm::min(low, place.first);
    high = number == 0 ? place.first : glm::max(high, place.first);
    order.push_back(place);
    if (groups.empty() || groups.back().firstSlice != firstSlice)
        groups.push_back({firstSlice, number, number});
    groups.back().end = number + 1;
}

void LitBlocks::readClasses(int sliceAxis, std::uint16_t* classes) const {
    parallelForChunks(size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t number = begin; number < end; ++number)
            readClasses(blocks_[number], sliceAxis, classes + 512 * number);
    });
}

void LitBlocks::readClasses(const Block& block, int sliceAxis, std::uint16_t* out) const {
    if (!block.leaf) {
        std::fill_n(out, 512, std::uint16_t(block.tileClass));
        return;
    }
    readLeafSlices(
        *block.leaf, sliceAxis, [&](Code code) { return classOfSlot_[std::size_t(code) + 1]; },
        out);
}

// Visits blocks from the nearest on until no voxel of the next block can be nearer.
LitBlocks::Reach LitBlocks::reachFrom(const glm::dvec3& placeIndex,
                                      const glm::dmat3& worldFromIndex) const {
    constexpr double kMiddle = 3.5;
    double radius = 0;  // of a block's voxels around its middle
    for (const glm::dvec3 corner :
         {glm::dvec3(1, 1, 1), glm::dvec3(-1, 1, 1), glm::dvec3(1, -1, 1), glm::dvec3(1, 1, -1)})
        radius = std::max(radius, glm::length(worldFromIndex * (kMiddle * corner)));
    std::vector<std::pair<double, std::size_t>> middles;
    Reach reach{std::numeric_limits<double>::infinity(), 0};
    for (std::size_t number = 0; number < size(); ++number) {
        const glm::dvec3 middle = 8.0 * glm::dvec3(blocks_[number].position) + kMiddle;
        const double distance = glm::length(worldFromIndex * (middle - placeIndex));
        middles.emplace_back(distance, number);
        reach.farthest = std::max(reach.farthest, distance + radius);
    }
    std::sort(middles.begin(), middles.end());
    std::array<std::uint16_t, 512> classes;
    for (const auto& [distance, number] : middles) {
        if (distance - radius > reach.nearest) break;
        const Block& block = blocks_[number];
        readClasses(block, 0, classes.data());
        forLeafVoxels(0, [&](const glm::ivec3& place, int n) {
            if (classes[std::size_t(n)] == 0) return;
            const glm::dvec3 way(glm::dvec3(8 * block.position + place) - placeIndex);
            reach.nearest = std::min(reach.nearest, glm::length(worldFromIndex * way));
        });
    }
    return reach;
}

std::size_t LitBlocks::Hash::operator()(const glm::ivec3& position) const {
    // Odd numbers that spread neighbours.
    const glm::u64vec3 parts{glm::u32vec3(position)};
    const std::uint64_t hash =
        parts.x * 0x9E3779B97F4A7C15 ^ parts.y * 0xC2B2AE3D27D4EB4F ^ parts.z * 0x165667B19E3779F9;
    return std::size_t(hash ^ hash >> 32);
}

}  // namespace deltasplat
