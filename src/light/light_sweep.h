// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "light/lit_blocks.h"

namespace deltasplat {

/// What light comes through on its way to each voxel of a volume, slice by slice from where it
/// enters: each slice's voxels read what the slices before have added up, then add what they are
/// themselves. What is added up lies on a plane that moves with the light, so that nothing is
/// blurred more than twice, by reading and by adding, however many slices there are.
class LightSweep {
  public:
    /// @param way  that light travels in the world, of any length but 0
    LightSweep(const LitBlocks& blocks, const ClassTable& classes, const glm::dmat4& worldFromIndex,
               const glm::dvec3& way);

    /// Rows that the plane has, 0 without blocks. It can be cut into strips of rows that are swept
    /// by themselves, without changing anything.
    std::int64_t rows() const { return lastRow_ - firstRow_; }
    /// Bytes that sweeping such a strip takes.
    double bytes(std::int64_t first, std::int64_t last) const {
        return double(sizeof(float)) * (double(last) - first + 1) * columns_;
    }
    /// Along which slices follow each other.
    int sliceAxis() const { return axis_; }
    /// Sweeps a strip. Voxels that it does not reach are left to others.
    /// @param first,last  rows [first, last) of [0, rows())
    /// @param classes     LitBlocks::classesAlong(sliceAxis())
    /// @param depths      of blocks, `[x][y][z]` each: square roots of extinction, in 1 /
    ///                    kDepthSteps
    void run(std::int64_t first, std::int64_t last, const std::uint16_t* classes,
             std::uint16_t* depths) const;

  private:
    // Blocks of [begin, end) have their voxels in the same eight slices.
    struct Group {
        int firstSlice;
        std::size_t begin;
        std::size_t end;
    };
    struct Strip;

    void sortBlocks();
    void findRows();
    glm::dvec2 placeOf(int slice) const { return -double(slice - origin_) * shift_; }
    void sweepSlice(const Group& group, int slice, Strip& strip) const;

    const LitBlocks& blocks_;
    int axis_;
    bool forward_;                  // light travels towards larger slices
    glm::dvec2 shift_;              // (u, v) by which it moves from a slice to the next larger one
    int origin_ = 0;                // slice in which the plane lies as voxels do
    std::vector<float> metDepths_;  // [classes]: as MetClasses
    std::vector<float> metMeans_;   // likewise
    std::vector<std::uint32_t> order_;  // of blocks, by slice, u and v
    std::vector<Group> groups_;         // in the order of the light
    std::int64_t firstRow_ = 0;
    std::int64_t lastRow_ = 0;
    std::int64_t firstColumn_ = 0;
    std::int64_t columns_ = 0;
};

}  // namespace deltasplat
