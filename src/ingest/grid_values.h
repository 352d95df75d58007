// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/Coord.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "ingest/value_census.h"
#include "parallel.h"

namespace deltasplat {

/// What the active values of a grid hold.
struct GridScan {
    ValueCensus census;           ///< of the finite values
    std::uint64_t nonFinite = 0;  ///< voxels
    openvdb::Coord first;         ///< the non-finite voxel with the smallest z, then y, then x

    void addNonFinite(const openvdb::Coord& place, std::uint64_t voxels) {
        if (nonFinite == 0 || isBefore(place, first)) first = place;
        nonFinite += voxels;
    }
    void append(const GridScan& other) {
        census.append(other.census);
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
    auto tile = tree.beginValueOn();  // constant where the tree is
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) use(tile);
}

/// Returns what the active values of `tree` hold; the result does not depend on the thread count.
/// @param distinct  whether to collect different values
template <typename Tree>
GridScan scanTree(Tree& tree, bool distinct) {
    std::vector<typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    std::vector<GridScan> scans(leaves.size() / kLeafRun + 1);
    const auto add = [](GridScan& scan, const auto& value, std::uint64_t voxels) {
        if (isFinite(*value)) {
            scan.census.add(*value);
        } else {
            scan.addNonFinite(value.getCoord(), voxels);
        }
    };
    forLeafRuns(leaves.size(), [&](std::size_t run, std::size_t begin, std::size_t end) {
        if (!distinct) scans[run].census.distinct.giveUp();
        for (std::size_t i = begin; i < end; ++i) {
            for (auto voxel = leaves[i]->cbeginValueOn(); voxel; ++voxel) add(scans[run], voxel, 1);
        }
    });
    GridScan whole;
    for (const GridScan& scan : scans) whole.append(scan);
    forActiveTiles(tree, [&](const auto& tile) { add(whole, tile, tile.getVoxelCount()); });
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
