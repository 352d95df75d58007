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

/// The leaves of a grid as they lie in its file, packed: each is unpacked by whoever wants its
/// values, on any thread, and no tree is made of them. They may be some of the grid's.
class VdbLeaves {
  public:
    static constexpr int kVoxels = 512;
    using Mask = std::array<std::uint64_t, kVoxels / 64>;  ///< [x]: bit 8 y + z
    /// Room for a leaf's values as they are stored, and what Blosc wants besides to unpack them.
    template <typename Stored>
    using Values = std::array<Stored, kVoxels + 64 / sizeof(Stored)>;

    /// @param runs    that hold the leaves' values, by where they begin
    VdbLeaves(std::vector<VdbRun> runs, std::vector<VdbLeaf> leaves, const VdbValueFormat& format,
              openvdb::math::Transform::ConstPtr transform);

    const std::vector<VdbLeaf>& leaves() const { return leaves_; }
    const openvdb::math::Transform& transform() const { return *transform_; }
    /// Returns which voxels of a leaf are active.
    Mask maskOf(const VdbLeaf& leaf) const;
    /// Unpacks the values of a leaf's active voxels, in the order of the mask's bits: `mask` is
    /// that of the leaf. Thread-safe.
    /// @tparam Stored  of the format's size: a number, or the std::uint16_t that a half is
    /// @param room     may be written to
    /// @return within `room`; none, with `mask` not empty, if the values are damaged
    template <typename Stored>
    std::span<const Stored> activeValues(const VdbLeaf& leaf, const Mask& mask,
                                         Values<Stored>& room) const;

  private:
    const char* at(std::uint64_t position) const;
    bool unpack(const VdbLeaf& leaf, std::span<char> values) const;

    std::vector<VdbRun> runs_;
    std::vector<VdbLeaf> leaves_;
    VdbValueFormat format_;
    openvdb::math::Transform::ConstPtr transform_;
};

}  // namespace deltasplat
