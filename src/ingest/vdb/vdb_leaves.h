// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/math/Transform.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ingest/vdb/vdb_walk.h"

namespace deltasplat {

/// Some bytes of a file, from `begin` on.
struct VdbRun {
    std::uint64_t begin;
    std::vector<char> bytes;
};

/// The leaves of a grid of int32 as they lie in its file, packed: each is unpacked by whoever wants
/// its values, on any thread, and no tree is made of them. They may be some of the grid's.
class VdbLeaves {
  public:
    static constexpr int kVoxels = 512;
    using Mask = std::array<std::uint64_t, kVoxels / 64>;  ///< [x]: bit 8 y + z
    /// Room for a leaf's values, and what Blosc wants besides to unpack them.
    using Values = std::array<std::int32_t, kVoxels + 16>;

    /// @param runs      that hold the leaves' values, by where they begin
    /// @param isPacked  whether values are packed by Blosc
    VdbLeaves(std::vector<VdbRun> runs, std::vector<VdbLeaf> leaves, std::int32_t background,
              bool isPacked, openvdb::math::Transform::ConstPtr transform);

    const std::vector<VdbLeaf>& leaves() const { return leaves_; }
    const openvdb::math::Transform& transform() const { return *transform_; }
    std::int32_t background() const { return background_; }
    /// Returns which voxels of a leaf are active.
    Mask maskOf(const VdbLeaf& leaf) const;
    /// Unpacks the values of a leaf's active voxels, in the order of the mask's bits: `mask` is
    /// that of the leaf. Thread-safe.
    /// @param room  may be written to
    /// @return within `room`; none, with `mask` not empty, if the values are damaged
    std::span<const std::int32_t> activeValues(const VdbLeaf& leaf, const Mask& mask,
                                               Values& room) const;

  private:
    const char* at(std::uint64_t position) const;
    bool unpack(const VdbLeaf& leaf, Values& values) const;

    std::vector<VdbRun> runs_;
    std::vector<VdbLeaf> leaves_;
    std::int32_t background_;
    bool isPacked_;
    openvdb::math::Transform::ConstPtr transform_;
};

}  // namespace deltasplat
