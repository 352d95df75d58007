// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/progress.h"
#include "formats/vdb/vdb_file.h"
#include "volume/grid_values.h"

namespace deltasplat {

/// What TreeLeaves is, of a grid whose leaves' values are still in their file, packed.
/// @tparam T       the grid's value type
/// @tparam Stored  what values are in the file: that, or the std::uint16_t that a half is
template <typename T, typename Stored = T>
class FileLeaves {
  public:
    using Value = T;
    struct Room : VdbLeaves::Room<Stored> {
        LeafMask mask;  // of the last leaf whose values were asked for
    };

    /// @param passes    over all leaves, how many are to be expected
    /// @param listener  hears how far leaves are asked for
    FileLeaves(const VdbValues& values, T background, int passes, const Listener& listener)
        : packed_(values.leaves),
          tiles_(values.tiles),
          background_(background),
          passes_(passes),
          progress_(listener) {}

    T background() const { return background_; }
    std::span<const T> tileValues() const { return tiles_.template values<T>(); }
    template <typename Use>
    void forTileRuns(const Use& use) const {
        use(std::span(tiles_.places()), tileValues());
    }
    std::size_t count() const { return packed_.leaves().size(); }
    openvdb::Coord place(std::size_t i) const {
        return openvdb::Coord(packed_.leaves()[i].origin.data());
    }
    const LeafMask& mask(std::size_t, const Room& room) const { return room.mask; }
    /// Of a leaf whose values are damaged there are none.
    std::span<const Stored> values(std::size_t i, Room& room) const {
        if (i == 0) ++pass_;
        if (i % kLeafRun == 0) {
            const double done = pass_ - 1 + double(i) / double(count());
            progress_.report(std::min(1.0, done / passes_));
        }
        const auto values = packed_.activeValues(packed_.leaves()[i], room.mask, room);
        if (values) return *values;
        areDamaged_ = true;
        room.mask = {};
        return {};
    }
    /// Whether any that were asked for were.
    bool areDamaged() const { return areDamaged_; }

    /// Returns a tree for codes of these leaves, which have no room for them, with those of tiles.
    /// @param filled  becomes its leaves
    std::shared_ptr<CodeTree> makeCodes(const std::vector<Code>& tileCodes,
                                        std::vector<CodeTree::Leaf*>& filled) const {
        std::vector<openvdb::Coord> places(count());
        for (std::size_t i = 0; i < places.size(); ++i) places[i] = place(i);
        auto codes = std::make_shared<CodeTree>();
        filled = addNodes(places, tiles_.places(), tileCodes, codes->tree());
        return codes;
    }
    /// Makes room for codes in a leaf of that tree, those whose values were asked for last.
    void makeRoom(const Room& room, CodeTree::Leaf& leaf) const {
        for (openvdb::Index x = 0; x < room.mask.size(); ++x)
            leaf.getValueMask().template getWord<std::uint64_t>(x) = room.mask[x];
        leaf.allocate();
        if (!leaf.isDense()) leaf.buffer().fill(Code{0});
    }

  private:
    const VdbLeaves& packed_;
    const VdbTiles& tiles_;
    T background_;
    int passes_;
    mutable std::atomic<int> pass_ = 0;
    mutable SharedProgress progress_;
    mutable std::atomic<bool> areDamaged_ = false;
};

}  // namespace deltasplat
