// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "rays/ray_volume.h"
#include "uncleared_array.h"

namespace deltasplat {

/// A volume's values as floats in bricks of 8x8x8 voxels (x slowest, z fastest), for rays that go
/// any way. All places within a brick around the volume's can be read. Immutable, so thread-safe.
///
/// Positions are counted from the first voxel of the first brick of this border, and are not
/// negative.
class RayBricks {
  public:
    /// How far neighbours along x, y and z lie from each other.
    struct Strides {
        std::ptrdiff_t x, y, z;
        std::ptrdiff_t operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    };
    static constexpr Strides kVoxel{64, 8, 1};

    /// @param volume  of slice axis 0
    /// @param empty   what places hold that are not active
    /// @throw Error(kFailed) if it does not fit into memory
    RayBricks(const RayVolume& volume, float empty);

    /// Voxel index of position (0, 0, 0).
    const glm::ivec3& origin() const { return origin_; }
    /// Strides of bricks, in numbers.
    const Strides& brickStrides() const { return strides_; }
    /// The numbers of bricks: 0 is one that is empty.
    const std::uint32_t* numbers() const { return numbers_.data(); }
    /// A brick's 512 values.
    const float* values(std::uint32_t number) const { return &values_[512 * std::size_t(number)]; }

  private:
    glm::ivec3 origin_{0};
    Strides strides_{};
    std::vector<std::uint32_t> numbers_;
    UnclearedArray<float> values_;
};

/// Four voxels of a slice that lie beside each other.
struct BrickTaps {
    float first, nextV, nextU, nextBoth;
};

/// Reads bricks at positions of one slice after the other, along any axis.
class BrickReader {
  public:
    /// @param order  sliceOrder of the axis; bricks must outlive the reader
    BrickReader(const RayBricks& bricks, const glm::ivec3& order)
        : bricks_(bricks),
          brickS_(bricks.brickStrides()[order[0]]),
          brickU_(bricks.brickStrides()[order[1]]),
          brickV_(bricks.brickStrides()[order[2]]),
          voxelS_(RayBricks::kVoxel[order[0]]),
          voxelU_(RayBricks::kVoxel[order[1]]),
          voxelV_(RayBricks::kVoxel[order[2]]) {}

    /// Reads the voxel (u, v) of a slice and those that follow; false if all are in empty bricks.
    bool read(int slice, int u, int v, BrickTaps& taps) const {
        const std::uint32_t* number =
            bricks_.numbers() + (slice >> 3) * brickS_ + (u >> 3) * brickU_ + (v >> 3) * brickV_;
        const std::ptrdiff_t in = (slice & 7) * voxelS_ + (u & 7) * voxelU_ + (v & 7) * voxelV_;
        const bool crossesU = (u & 7) == 7;
        const bool crossesV = (v & 7) == 7;
        if (!crossesU && !crossesV) {
            if (*number == 0) return false;
            const float* const first = bricks_.values(*number) + in;
            taps.first = first[0];
            taps.nextV = first[voxelV_];
            taps.nextU = first[voxelU_];
            taps.nextBoth = first[voxelU_ + voxelV_];
            return true;
        }
        const std::ptrdiff_t nextU = crossesU ? brickU_ : 0;
        const std::ptrdiff_t nextV = crossesV ? brickV_ : 0;
        const std::ptrdiff_t inU = in + (crossesU ? -7 : 1) * voxelU_;
        const std::ptrdiff_t toV = (crossesV ? -7 : 1) * voxelV_;
        const std::uint32_t all[] = {number[0], number[nextV], number[nextU],
                                     number[nextU + nextV]};
        if ((all[0] | all[1] | all[2] | all[3]) == 0) return false;
        taps.first = bricks_.values(all[0])[in];
        taps.nextV = bricks_.values(all[1])[in + toV];
        taps.nextU = bricks_.values(all[2])[inU];
        taps.nextBoth = bricks_.values(all[3])[inU + toV];
        return true;
    }

  private:
    const RayBricks& bricks_;
    std::ptrdiff_t brickS_, brickU_, brickV_;
    std::ptrdiff_t voxelS_, voxelU_, voxelV_;
};

}  // namespace deltasplat
