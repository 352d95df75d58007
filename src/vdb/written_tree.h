// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

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

}  // namespace deltasplat
