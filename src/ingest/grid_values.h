// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/Coord.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "parallel.h"

namespace deltasplat {

/// What the active values of a grid span. Only finite values count for `min`, `max` and `half`.
template <typename T>
struct GridRange {
    T min{};
    T max{};
    bool any = false;             ///< there is a finite value
    bool half = true;             ///< every finite value is a binary16 number
    std::uint64_t nonFinite = 0;  ///< voxels
    openvdb::Coord first;         ///< the non-finite voxel with the smallest z, then y, then x

    void add(T value) {
        min = any ? std::min(min, value) : value;
        max = any ? std::max(max, value) : value;
        any = true;
        if constexpr (std::is_floating_point_v<T>) {
            half = half && T(float(openvdb::math::half(float(value)))) == value;
        }
    }
    void addNonFinite(const openvdb::Coord& place, std::uint64_t voxels) {
        if (nonFinite == 0 || isBefore(place, first)) first = place;
        nonFinite += voxels;
    }
    void append(const GridRange& other) {
        if (other.any) {
            min = any ? std::min(min, other.min) : other.min;
            max = any ? std::max(max, other.max) : other.max;
            any = true;
            half = half && other.half;
        }
        if (other.nonFinite > 0) addNonFinite(other.first, other.nonFinite);
    }
    static bool isBefore(const openvdb::Coord& a, const openvdb::Coord& b) {
        if (a.z() != b.z()) return a.z() < b.z();
        return a.y() != b.y() ? a.y() < b.y() : a.x() < b.x();
    }
};

template <typename T>
bool isFinite(T value) {
    if constexpr (std::is_floating_point_v<T>) return std::isfinite(value);
    return true;
}

/// How many leaves one thread takes at a time.
inline constexpr std::size_t kLeafRun = 128;

/// Calls body(run, begin, end) for runs of leaf numbers that together are 0..count, on all threads.
template <typename Body>
void forLeafRuns(std::size_t count, const Body& body) {
    parallelFor((count + kLeafRun - 1) / kLeafRun, [&](std::size_t run) {
        body(run, run * kLeafRun, std::min(count, (run + 1) * kLeafRun));
    });
}

/// Calls use(iterator) for every active tile of `tree`, of any level.
template <typename Tree, typename Use>
void forActiveTiles(Tree& tree, const Use& use) {
    auto tile = tree.beginValueOn();
    tile.setMaxDepth(Tree::ValueOnIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) use(tile);
}

/// Returns what the active values of `tree` span; the result does not depend on the thread count.
template <typename Tree>
GridRange<typename Tree::ValueType> rangeOfTree(Tree& tree) {
    using Range = GridRange<typename Tree::ValueType>;
    std::vector<typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    std::vector<Range> ranges(leaves.size() / kLeafRun + 1);
    forLeafRuns(leaves.size(), [&](std::size_t run, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (auto voxel = leaves[i]->cbeginValueOn(); voxel; ++voxel) {
                const auto value = *voxel;
                if (isFinite(value)) {
                    ranges[run].add(value);
                } else {
                    ranges[run].addNonFinite(voxel.getCoord(), 1);
                }
            }
        }
    });
    Range whole;
    for (const Range& range : ranges) whole.append(range);
    forActiveTiles(tree, [&](const auto& tile) {
        if (isFinite(*tile)) {
            whole.add(*tile);
        } else {
            whole.addNonFinite(tile.getCoord(), tile.getVoxelCount());
        }
    });
    return whole;
}

/// Gives every active value that is NaN or infinite the value `replacement`.
template <typename Tree>
void replaceNonFinite(Tree& tree, typename Tree::ValueType replacement) {
    for (auto value = tree.beginValueOn(); value; ++value) {
        if (!isFinite(*value)) value.setValue(replacement);
    }
}

}  // namespace deltasplat
