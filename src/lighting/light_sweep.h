// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "lighting/light_depths.h"
#include "lighting/lit_blocks.h"
#include "lighting/sweep_kernels.h"

namespace deltasplat {

/// The way of distant light through slices.
struct LightWay {
    /// @param way  that it travels in the world, finite, not 0
    LightWay(const glm::dmat4& worldFromIndex, const glm::dvec3& way);

    int sliceAxis;      ///< that it is most parallel to, in voxels
    bool forward;       ///< it travels towards larger slices
    glm::dvec2 shift;   ///< (u, v) by which it moves from a slice to the next larger one
    double sliceWorld;  ///< world units that it travels in a slice
};

/// What a block reads from or adds to of the plane that light is swept through.
struct PlaneReach : PlaneBox {
    int slice;  ///< its first
    LitBlocks::Along::Place place;
};

/// What light comes through on its way to each voxel of a volume, slice by slice from where it
/// enters: each slice's voxels read what the slices before have added up, then add what they are
/// themselves. What is added up lies on a plane that moves with the light, so that nothing is
/// blurred more than twice, by reading and by adding, however many slices there are.
class LightSweep {
  public:
    /// @param blocks  along the way's slice axis; must outlive this
    /// @param origin  slice in which the plane lies as voxels do
    /// @param met     what light meets in a slice on this way
    LightSweep(const LitBlocks::Along& blocks, const LightWay& way, int origin,
               const MetClasses& met);

    /// Rows that the plane has, 0 without blocks. It can be cut into strips of rows that are swept
    /// by themselves, without changing anything.
    std::int64_t rows() const { return lastRow_ - firstRow_; }
    /// Bytes that sweeping such a strip takes.
    double bytes(std::int64_t first, std::int64_t last) const {
        return double(sizeof(float)) * (double(last) - first + 1) * columns_;
    }
    /// Returns the blocks in parts that no light goes through from one to another, where these can
    /// be swept on much smaller planes: then each is to have a sweep of its own, from the same
    /// origin on, which changes nothing.
    std::vector<LitBlocks::Along> apart() const;
    /// Sweeps a strip. Voxels that it does not reach are left to others.
    /// @param first,last  rows [first, last) of [0, rows())
    /// @param depths      of blocks, `[x][y][z]` each: square roots of extinction, in 1 /
    ///                    kDepthSteps
    void run(std::int64_t first, std::int64_t last, std::uint16_t* depths) const;

  private:
    struct Strip;

    glm::dvec2 placeOf(int slice) const { return -(double(slice) - origin_) * way_.shift; }
    std::vector<PlaneReach> reaches() const;
    void findRows();
    void sweepSlice(const LitBlocks::Along::Group& group, int slice, Strip& strip) const;

    const LitBlocks::Along& blocks_;
    LightWay way_;
    int origin_;
    MetClasses met_;
    std::int64_t firstRow_ = 0;
    std::int64_t lastRow_ = 0;
    std::int64_t firstColumn_ = 0;
    std::int64_t columns_ = 0;
};

}  // namespace deltasplat
