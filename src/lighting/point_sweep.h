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

/// Where a point light stands among voxels, as they lie along a slice axis.
struct PointPlace {
    glm::dvec3 place;  ///< (slice, u, v), each at most 1e12
    /// What a step along slice, u and v is in the world, in units of what light meets
    /// (MetClasses).
    glm::dmat3 steps;
};

/// What the light of a point comes through on its way to those voxels that lie farthest from it
/// along one axis, one way: a sixth of space. Slices are swept from the light on, as LightSweep
/// does, on a plane that grows with the distance: a node of it stands for a way from the light, and
/// adds up what this way meets. From slices to those twice as far the nodes are doubled both ways,
/// so that voxels never lie closer than they do. What is between two nodes is so far mixed of them
/// anyway, so that this blurs nothing. Where planes are or would get large, what no voxel behind
/// reads is left out, and what lies far apart is swept by itself from there on.
class PointSweep {
  public:
    /// @param blocks   along the slice axis; must outlive this
    /// @param forward  to voxels of larger slices than the light's, and of its own
    /// @param met      what light meets in a slice on its shortest way
    PointSweep(const LitBlocks::Along& blocks, const PointPlace& light, bool forward,
               const MetClasses& met);

    /// Rows that the plane has, as far as light is to be known there; 0 if no voxel is. It can be
    /// cut into strips of rows that are swept by themselves, without changing anything.
    std::int64_t rows() const { return lastRow_ - firstRow_; }
    /// Bytes that sweeping such a strip takes.
    double bytes(std::int64_t first, std::int64_t last) const;
    /// Sweeps a strip. Voxels that it does not reach are left to others.
    /// @param first,last  rows [first, last) of [0, rows())
    /// @param depths      of blocks, `[x][y][z]` each: square roots of extinction, in 1 /
    ///                    kDepthSteps
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
    // Nodes where slices begin: rows and columns from the light's own, `nodes_` for a slope of 1.
    double nodes_ = 1;
    std::int64_t firstRow_ = 0;
    std::int64_t lastRow_ = 0;
    std::int64_t firstColumn_ = 0;
    std::int64_t lastColumn_ = 0;
};

}  // namespace deltasplat
