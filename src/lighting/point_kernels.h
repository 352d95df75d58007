// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace deltasplat {

/// Least nodes for a slope of 1 (PointSweep): voxels near the light appear large.
inline constexpr int kLeastNodes = 32;

/// Nodes of a row or column on a block. before[n] is the voxel before node n: 0 lies before the
/// block, 8 is the block's last voxel. share[n] is node n's place on the way to the next voxel.
struct NodesOnBlock {
    /// All nodes of the initial plane; later at most two per voxel.
    static constexpr std::size_t kMost = 2 * kLeastNodes + 4;
    static_assert(kMost > 2 * 9 + 2);
    std::int64_t first = 0;  ///< node
    std::size_t count = 0;
    std::array<std::uint32_t, kMost> before;
    std::array<float, kMost> share;
};

/// Adds the extinctions in a slice of a block, interpolated at each node and 0 beyond the block.
/// @param out  the first node
/// @param own  [64], of which `share` counts
void addToNodes(const NodesOnBlock& rows, const NodesOnBlock& columns, const float* own,
                float share, float* out, std::size_t pitch);

/// Voxels [begin, end) of the eight of a row or column, between nodes.
struct VoxelsBetweenNodes {
    int begin = 0;
    int end = 0;
    std::array<std::ptrdiff_t, 8> before;  ///< node
    std::array<float, 8> share;            ///< of the way to the next node: 0..1
    std::array<glm::vec3, 8> way;          ///< part of the light's way through a slice
};

/// Reads the extinction on the way to voxels, as square roots in 1 / kDepthSteps.
/// @param plane   node 0
/// @param out     voxel (0, 0) of the slice
/// @param stride  between voxels of `out` along u and v
void readBetweenNodes(const VoxelsBetweenNodes& rows, const VoxelsBetweenNodes& columns,
                      const float* plane, std::size_t pitch, std::uint16_t* out, glm::ivec2 stride);

}  // namespace deltasplat
