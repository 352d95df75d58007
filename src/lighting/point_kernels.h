// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace deltasplat {

/// How many nodes a plane has at least for a slope of 1 (PointSweep): near the light, where voxels
/// are large, there are more than voxels.
inline constexpr int kLeastNodes = 32;

/// Nodes that lie on a block, of a row or a column: before[n] is the voxel before node n, 0 being
/// the one before the block and 8 its last, and share[n] how far it is on the way to the next.
struct NodesOnBlock {
    /// All nodes of a plane that is doubled for nothing yet; later two for each voxel.
    static constexpr std::size_t kMost = 2 * kLeastNodes + 4;
    static_assert(kMost > 2 * 9 + 2);
    std::int64_t first = 0;  ///< node
    std::size_t count = 0;
    std::array<std::uint32_t, kMost> before;
    std::array<float, kMost> share;
};

/// Adds what light comes through in a slice of a block: each node what there is where it lies,
/// between voxels, and none beyond the block.
/// @param out    the first node
/// @param own    [64]
/// @param share  of the slice
void addToNodes(const NodesOnBlock& rows, const NodesOnBlock& columns, const float* own,
                float share, float* out, std::size_t pitch);

/// Where voxels of a row or a column lie between nodes, [begin, end) of eight.
struct VoxelsBetweenNodes {
    int begin = 0;
    int end = 0;
    std::array<std::ptrdiff_t, 8> before;  ///< node
    std::array<float, 8> share;            ///< of the way to the next: 0..1
    std::array<glm::vec3, 8> way;          ///< of light in a slice: its part by this place
};

/// Reads what light has come through before it comes to voxels, as square roots in 1 / kDepthSteps.
/// @param plane   node 0
/// @param out     voxel (0, 0) of the slice
/// @param stride  from a voxel of `out` to the next along u and v
void readBetweenNodes(const VoxelsBetweenNodes& rows, const VoxelsBetweenNodes& columns,
                      const float* plane, std::size_t pitch, std::uint16_t* out, glm::ivec2 stride);

}  // namespace deltasplat
