// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/Coord.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "deltasplat/threads.h"
#include "volume/code_nodes.h"
#include "volume/value_census.h"

namespace deltasplat {

template <typename T>
bool isFinite(T value) {
    if constexpr (std::is_floating_point_v<T>) return std::isfinite(value);
    return true;
}

/// The active voxels of a leaf. [x]: bit 8 y + z
using LeafMask = std::array<std::uint64_t, 8>;

template <typename Leaf>
LeafMask maskOf(const Leaf& leaf) {
    LeafMask mask;
    for (openvdb::Index x = 0; x < mask.size(); ++x)
        mask[x] = leaf.valueMask().template getWord<std::uint64_t>(x);
    return mask;
}

struct GridScan {
    ValueCensus census;           ///< of the finite values
    std::uint64_t nonFinite = 0;  ///< number of voxels
    openvdb::Coord first;         ///< the non-finite voxel with the smallest z, then y, then x

    void addNonFinite(const openvdb::Coord& place, std::uint64_t voxels) {
        if (nonFinite == 0 || isBefore(place, first)) first = place;
        nonFinite += voxels;
    }
    /// @param origin  of a leaf
    /// @param values  of its active voxels, of which some are not finite
    template <typename T>
    void addOneByOne(const openvdb::Coord& origin, const LeafMask& mask,
                     std::span<const T> values) {
        auto value = values.begin();
        for (int x = 0; x < int(mask.size()); ++x) {
            for (std::uint64_t rest = mask[std::size_t(x)]; rest != 0; rest &= rest - 1, ++value) {
                const int bit = std::countr_zero(rest);
                if (isFinite(*value)) {
                    census.add(*value);
                } else {
                    addNonFinite(origin.offsetBy(x, bit / 8, bit % 8), 1);
                }
            }
        }
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

inline constexpr std::size_t kLeafRun = 128;

/// Calls body(run, begin, end) on all threads, for runs that together cover leaves 0 to count - 1.
template <typename Body>
void forLeafRuns(std::size_t count, const Body& body) {
    parallelFor((count + kLeafRun - 1) / kLeafRun, [&](std::size_t run) {
        body(run, run * kLeafRun, std::min(count, (run + 1) * kLeafRun));
    });
}

/// Calls body(worker, begin, end) on `workers` workers. Calls of one worker never overlap.
template <typename Body>
void forLeafRuns(std::size_t count, std::size_t workers, const Body& body) {
    const std::size_t runs = (count + kLeafRun - 1) / kLeafRun;
    std::atomic<std::size_t> next = 0;
    parallelFor(workers, [&](std::size_t worker) {
        for (std::size_t run = next++; run < runs; run = next++)
            body(worker, run * kLeafRun, std::min(count, (run + 1) * kLeafRun));
    });
}

/// Calls use(n, value) for the active voxels of a leaf. n is the place in the leaf.
template <typename Leaf, typename Use>
void forActiveVoxels(const Leaf& leaf, const Use& use) {
    if constexpr (std::is_same_v<typename Leaf::ValueType, bool>) {
        for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) use(voxel.pos(), *voxel);
    } else {
        const auto* values = leaf.buffer().data();
        for (openvdb::Index row = 0; row < Leaf::SIZE; row += 64) {
            auto active = leaf.valueMask().template getWord<std::uint64_t>(row / 64);
            for (; active != 0; active &= active - 1) {
                const openvdb::Index n = row + openvdb::Index(std::countr_zero(active));
                use(n, values[n]);
            }
        }
    }
}

template <typename Leaf>
using LeafRoom = std::array<typename Leaf::ValueType, Leaf::SIZE>;

/// Returns a leaf's active values in order of place: the leaf's own, or a copy in `room`.
template <typename Leaf>
std::span<const typename Leaf::ValueType> activeValues(const Leaf& leaf, LeafRoom<Leaf>& room) {
    if constexpr (!std::is_same_v<typename Leaf::ValueType, bool>) {
        if (leaf.isDense()) return {leaf.buffer().data(), Leaf::SIZE};
    }
    std::size_t count = 0;
    forActiveVoxels(leaf, [&](openvdb::Index, const auto& value) { room[count++] = value; });
    return {room.data(), count};
}

/// Calls use(iterator) for every active tile of `tree`, at any level.
template <typename Tree, typename Use>
void forActiveTiles(Tree& tree, const Use& use) {
    auto tile = tree.beginValueOn();  // const if `tree` is const
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) use(tile);
}

/// The active nodes of a tree: leaves with the values of their active voxels, and active tiles.
template <typename Tree>
class TreeLeaves {
  public:
    using Value = typename Tree::ValueType;
    using Room = LeafRoom<typename Tree::LeafNodeType>;

    explicit TreeLeaves(const Tree& tree) : tree_(tree) { tree.getNodes(leaves_); }

    Value background() const { return tree_.background(); }
    /// Calls use(places, values) for groups of active tiles.
    template <typename Use>
    void forTileRuns(const Use& use) const {
        constexpr std::size_t kMost = 4096;
        std::vector<TilePlace> places;
        const auto values = std::make_unique<Value[]>(kMost);
        const auto flush = [&] {
            use(std::span<const TilePlace>(places),
                std::span<const Value>(values.get(), places.size()));
            places.clear();
        };
        forActiveTiles(tree_, [&](const auto& tile) {
            values[places.size()] = *tile;
            places.push_back({tile.getCoord(), tile.getLevel()});
            if (places.size() == kMost) flush();
        });
        if (!places.empty()) flush();
    }
    std::size_t count() const { return leaves_.size(); }
    openvdb::Coord place(std::size_t i) const { return leaves_[i]->origin(); }
    /// @param room  after a call of values() for this leaf
    LeafMask mask(std::size_t i, const Room&) const { return maskOf(*leaves_[i]); }
    /// Returns the values of a leaf's active voxels in the order of their places. Thread-safe.
    /// @param room  may be overwritten
    std::span<const typename Tree::ValueType> values(std::size_t i, Room& room) const {
        return activeValues(*leaves_[i], room);
    }
    /// Whether the values of any leaf could not be read.
    bool areDamaged() const { return false; }
    /// Returns a tree for the codes of these leaves. Tiles have their codes already.
    /// @param filled  receives the leaves of the returned tree
    std::shared_ptr<CodeTree> makeCodes(const std::vector<Code>& tileCodes,
                                        std::vector<CodeTree::Leaf*>& filled) const {
        auto codes =
            std::make_shared<CodeTree>(std::in_place, tree_, Code{0}, openvdb::TopologyCopy());
        auto code = tileCodes.begin();
        forActiveTiles(codes->tree(), [&](const auto& tile) { tile.setValue(*code++); });
        codes->tree().getNodes(filled);
        return codes;
    }
    /// Makes room for codes in a leaf of the returned tree, after a call of values() for this leaf.
    void makeRoom(const Room&, CodeTree::Leaf&) const {}

  private:
    const Tree& tree_;
    std::vector<const typename Tree::LeafNodeType*> leaves_;
};

/// Optional findings of a scan, besides the numbers of the census.
struct ScanWishes {
    bool distinct = true;  ///< different values
    bool survey = true;    ///< distribution of values
};

/// The numbers alone: quick to find, and mostly sufficient.
inline constexpr ScanWishes kNumbersAlone{.distinct = false, .survey = false};

/// Returns what the active values of a tree hold; the result does not depend on the thread count.
/// @param leaves  TreeLeaves, or a class with the same members
template <typename Leaves>
GridScan scanLeaves(const Leaves& leaves, const ScanWishes& wishes) {
    GridScan whole;
    if (!wishes.distinct) whole.census.distinct.giveUp();
    whole.census.skipSurvey = !wishes.survey;
    // Runs are merged early, because each takes megabytes; the first few tell whether to collect.
    constexpr std::size_t kFewRuns = 8;
    const std::size_t mostRuns = std::clamp<std::size_t>(2 * threadCount(), kFewRuns, 64);
    std::size_t runs = kFewRuns;
    std::size_t count = 0;
    for (std::size_t start = 0; start < leaves.count(); start += count) {
        count = std::min(runs * kLeafRun, leaves.count() - start);
        runs = std::min(2 * runs, mostRuns);
        std::vector<GridScan> scans((count + kLeafRun - 1) / kLeafRun);
        forLeafRuns(count, [&](std::size_t run, std::size_t begin, std::size_t end) {
            ValueCensus& census = scans[run].census;
            if (whole.census.distinct.tooMany()) census.distinct.giveUp();
            census.skipSurvey = !wishes.survey;
            typename Leaves::Room room;
            for (std::size_t i = start + begin; i < start + end; ++i) {
                const auto values = leaves.values(i, room);
                if (!census.addAll(values)) {
                    scans[run].addOneByOne(leaves.place(i), leaves.mask(i, room), values);
                }
            }
        });
        for (const GridScan& scan : scans) whole.append(scan);
    }
    leaves.forTileRuns([&](const auto& places, const auto& values) {
        if (whole.census.addAll(values)) return;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (isFinite(values[i])) {
                whole.census.add(values[i]);
            } else {
                whole.addNonFinite(places[i].origin, places[i].voxels());
            }
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
