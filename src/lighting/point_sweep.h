// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "lighting/lit_blocks.h"
#include "lighting/sweep_kernels.h"

namespace deltasplat {

/// Where a point light stands among voxels in the order of a slice axis.
struct PointPlace {
    glm::dvec3 place;  ///< (slice, u, v), each at most 1e12
    /// World length of a step along slice, u and v, in units of MetClasses.
    glm::dmat3 steps;
};

/// Extinction on the ways from a point to the voxels that lie farthest from it along one axis in
/// one direction: a sixth of space. Like LightSweep, sweeps slices from the light on, but the plane
/// grows with the distance. A node stands for a way from the light and sums the extinction along
/// it. At twice the distance, the number of nodes doubles both ways, so that voxels never lie
/// closer than nodes; this blurs nothing, because values between nodes are interpolated anyway.
/// Large planes drop nodes that no voxel behind reads, and separate parts are swept separately.
class PointSweep {
  public:
    /// @param blocks   along the slice axis; must outlive this
    /// @param forward  towards larger slices, including the light's own slice
    /// @param met      for the shortest way through a slice
    PointSweep(const LitBlocks::Along& blocks, const PointPlace& light, bool forward,
               const MetClasses& met);

    /// Rows of the plane; 0 if no voxel needs light. Strips of rows can be swept separately.
    std::int64_t rows() const { return lastRow_ - firstRow_; }
    double bytes(std::int64_t first, std::int64_t last) const;
    /// Sweeps a strip; writes only the voxels that it reaches.
    /// @param first,last  rows [first, last) of [0, rows())
    /// @param depths      per block, `[x][y][z]`: square roots of extinction, in 1 / kDepthSteps
    void run(std::int64_t first, std::int64_t last, std::uint16_t* depths) const;

  private:
    struct Strip;

    double distanceOf(int slice) const;
    void findGroups();
    void findRows();
    // Blocks from the light on.
    struct Blocks {
        std::vector<LitBlocks::Along::Group> groups;  // of places
        std::vector<LitBlocks::Along::Place> places;
    };
    double sweep(std::int64_t first, std::int64_t last, std::uint16_t* depths) const;
    double sweepBlocks(const Blocks& blocks, Strip& strip) const;
    std::optional<double> sweepApart(const Blocks& blocks, std::size_t group,
                                     const Strip& strip) const;
    void sweepSlice(const Blocks& blocks, const LitBlocks::Along::Group& group, int slice,
                    Strip& strip) const;
    void read(const LitBlocks::Along::Place& block, double distance, const Strip& strip,
              std::uint16_t* out) const;

    const LitBlocks::Along& blocks_;
    PointPlace light_;
    bool forward_;
    MetClasses met_;
    Blocks ahead_;
    // Nodes of the first plane: rows and columns relative to the light, `nodes_` for a slope of 1.
    double nodes_ = 1;
    std::int64_t firstRow_ = 0;
    std::int64_t lastRow_ = 0;
    std::int64_t firstColumn_ = 0;
    std::int64_t lastColumn_ = 0;
};

}  // namespace deltasplat
