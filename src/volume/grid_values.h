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

/// Which voxels of a leaf are active. [x]: bit 8 y + z
using LeafMask = std::array<std::uint64_t, 8>;

template <typename Leaf>
LeafMask maskOf(const Leaf& leaf) {
    LeafMask mask;
    for (openvdb::Index x = 0; x < mask.size(); ++x)
        mask[x] = leaf.valueMask().template getWord<std::uint64_t>(x);
    return mask;
}

/// What the active values of a grid hold.
struct GridScan {
    ValueCensus census;           ///< of the finite values
    std::uint64_t nonFinite = 0;  ///< voxels
    openvdb::Coord first;         ///< the non-finite voxel with the smallest z, then y, then x

    void addNonFinite(const openvdb::Coord& place, std::uint64_t voxels) {
        if (nonFinite == 0 || isBefore(place, first)) first = place;
        nonFinite += voxels;
    }
    /// @param origin  of a leaf
    /// @param values  of its active voxels, some of them not finite
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

/// How many leaves one thread takes at a time.
inline constexpr std::size_t kLeafRun = 128;

/// Calls body(run, begin, end) for runs of leaf numbers that together are 0..count, on all threads.
template <typename Body>
void forLeafRuns(std::size_t count, const Body& body) {
    parallelFor((count + kLeafRun - 1) / kLeafRun, [&](std::size_t run) {
        body(run, run * kLeafRun, std::min(count, (run + 1) * kLeafRun));
    });
}

/// The same on so many workers, as body(worker, begin, end): of one worker, one call after the
/// other.
template <typename Body>
void forLeafRuns(std::size_t count, std::size_t workers, const Body& body) {
    const std::size_t runs = (count + kLeafRun - 1) / kLeafRun;
    std::atomic<std::size_t> next = 0;
    parallelFor(workers, [&](std::size_t worker) {
        for (std::size_t run = next++; run < runs; run = next++)
            body(worker, run * kLeafRun, std::min(count, (run + 1) * kLeafRun));
    });
}

/// Calls use(n, value) for the active voxels of a leaf, n being their places in it.
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

/// Room for the values of a leaf's active voxels.
template <typename Leaf>
using LeafRoom = std::array<typename Leaf::ValueType, Leaf::SIZE>;

/// Returns the values of a leaf's active voxels, in the order of their places: the leaf's own where
/// all are active, otherwise a copy in `room`.
template <typename Leaf>
std::span<const typename Leaf::ValueType> activeValues(const Leaf& leaf, LeafRoom<Leaf>& room) {
    if constexpr (!std::is_same_v<typename Leaf::ValueType, bool>) {
        if (leaf.isDense()) return {leaf.buffer().data(), Leaf::SIZE};
    }
    std::size_t count = 0;
    forActiveVoxels(leaf, [&](openvdb::Index, const auto& value) { room[count++] = value; });
    return {room.data(), count};
}

/// Calls use(iterator) for every active tile of `tree`, of any level.
template <typename Tree, typename Use>
void forActiveTiles(Tree& tree, const Use& use) {
    auto tile = tree.beginValueOn();  // constant where the tree is
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) use(tile);
}

/// The active nodes of a tree: its leaves with what their active voxels hold, and active tiles.
template <typename Tree>
class TreeLeaves {
  public:
    using Value = typename Tree::ValueType;
    using Room = LeafRoom<typename Tree::LeafNodeType>;

    explicit TreeLeaves(const Tree& tree) : tree_(tree) { tree.getNodes(leaves_); }

    Value background() const { return tree_.background(); }
    /// Calls use(places, values) for the active tiles, some at a time.
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
    /// Returns where a leaf's first voxel lies.
    openvdb::Coord place(std::size_t i) const { return leaves_[i]->origin(); }
    /// @param room  of values(), which were asked for before
    LeafMask mask(std::size_t i, const Room&) const { return maskOf(*leaves_[i]); }
    /// Returns the values of a leaf's active voxels, in the order of their places. Thread-safe.
    /// @param room  may be written to
    std::span<const typename Tree::ValueType> values(std::size_t i, Room& room) const {
        return activeValues(*leaves_[i], room);
    }
    /// Whether values of any leaf cannot be told.
    bool areDamaged() const { return false; }
    /// Returns a tree for codes of these leaves, with those of tiles.
    /// @param filled  becomes its leaves
    std::shared_ptr<CodeTree> makeCodes(const std::vector<Code>& tileCodes,
                                        std::vector<CodeTree::Leaf*>& filled) const {
        auto codes =
            std::make_shared<CodeTree>(std::in_place, tree_, Code{0}, openvdb::TopologyCopy());
        auto code = tileCodes.begin();
        forActiveTiles(codes->tree(), [&](const auto& tile) { tile.setValue(*code++); });
        codes->tree().getNodes(filled);
        return codes;
    }
    /// Makes room for codes in a leaf of that tree, those whose values were asked for last.
    void makeRoom(const Room&, CodeTree::Leaf&) const {}

  private:
    const Tree& tree_;
    std::vector<const typename Tree::LeafNodeType*> leaves_;
};

/// What a scan is to find out besides the census' numbers.
struct ScanWishes {
    bool distinct = true;  ///< different values
    bool survey = true;    ///< where values lie
};

/// What is told soon, and mostly is enough.
inline constexpr ScanWishes kNumbersAlone{.distinct = false, .survey = false};

/// Returns what the active values of a tree hold; the result does not depend on the thread count.
/// @param leaves  TreeLeaves, or what does the same
template <typename Leaves>
GridScan scanLeaves(const Leaves& leaves, const ScanWishes& wishes) {
    GridScan whole;
    if (!wishes.distinct) whole.census.distinct.giveUp();
    whole.census.skipSurvey = !wishes.survey;
    // Runs are put together as they are done: what each of them collects takes megabytes. The first
    // few tell the others whether there is any use in collecting.
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
