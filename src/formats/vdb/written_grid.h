// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/Maps.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "volume/tree_grid.h"
#include "volume/vdb_metadata.h"

namespace deltasplat {

/// What OpenVDB notes of a tree beside its values.
struct TreeFacts {
    std::string type;                ///< of values: "float", "int32", ...
    std::uint64_t activeVoxels = 0;  ///< those of tiles included
    std::uint64_t memoryBytes = 0;   ///< as a tree of OpenVDB's
    openvdb::CoordBBox activeBox;    ///< of active voxels
};

/// Leaves one behind the other as a file has them, and what OpenVDB's "file_delayed_load" notes of
/// each: how its inactive values are stored (openvdb::io's NO_MASK_..., MASK_...), and how many
/// bytes its packed values have, with their number.
struct PackedLeaves {
    std::string bytes;
    std::vector<std::int8_t> kinds;
    std::vector<std::int64_t> sizes;
};

/// A tree on its way into a .vdb file: packed by Blosc, without inactive values where these need
/// not be stored, as OpenVDB packs it.
class WrittenTree {
  public:
    virtual ~WrittenTree() = default;

    virtual TreeFacts facts() const = 0;
    /// Returns what comes before the values of leaves.
    /// @param half  whether real values are stored as halves
    virtual std::string topology(bool half) const = 0;
    virtual std::size_t leafCount() const = 0;
    /// Whether OpenVDB notes where leaves lie: of numbers and vectors, not of bools and masks.
    virtual bool notesLeaves() const = 0;
    /// Adds leaves, in the order of the file. Thread-safe.
    virtual void packLeaves(std::size_t begin, std::size_t end, bool half,
                            PackedLeaves& to) const = 0;
};

/// A grid on its way into a .vdb file.
struct WrittenGrid {
    std::string name;
    VdbMetadata metadata;  ///< what is noted anew whenever a file is written does not count
    openvdb::math::MapBase::ConstPtr map;
    std::shared_ptr<const WrittenTree> tree;
    bool packsNotes = true;  ///< whether what is noted of leaves' sizes is packed, as OpenVDB does

    /// Whether the metadata say that real values are stored as halves.
    bool isHalf() const;
};

/// Returns what is written of a scalar grid, or of one of vec3s: itself, which must not change.
/// @throw Error(kFailed) if it is of another type
WrittenGrid writtenGrid(const TreeGrid& grid);

/// Returns what is written of a grid of words (word_tree.h). These do not pack, so the notes of its
/// leaves are not packed either: Blosc takes longer to load than words take to read.
WrittenGrid writtenWords(const TreeGrid& grid);

/// Returns what is written of a grid of deltas, of int32 or int64: active values, on a background
/// of 0, sooner than writtenGrid() has it.
WrittenGrid writtenDeltas(const TreeGrid& grid);

}  // namespace deltasplat
