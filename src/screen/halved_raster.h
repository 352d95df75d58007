// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <memory_resource>
#include <vector>

#include "base/uncleared.h"
#include "screen/warp.h"

namespace deltasplat {

/// Lattice points [min, max).
struct LatticeBox {
    glm::ivec2 min;
    glm::ivec2 max;
};

/// A raster of half as many pixels along an axis or both. Pixel i lies in the middle between 2 i
/// and 2 i + 1, and is 1/8, 3/8, 3/8, 1/8 of the four from 2 i - 1 on: it has the linear ramps of
/// the first one and its mass, and little of the details that half as many pixels cannot hold.
class HalvedRaster {
  public:
    /// Where lattice points of the raster lie on the halved one's axes.
    static constexpr double halved(double position) { return (position - 0.5) / 2; }

    /// Multi-threaded.
    /// @param along   the axes
    /// @param wanted  of the halved lattice: others have no value, nor have those that are made of
    ///                such of `raster`
    /// @param memory  for the pixels
    HalvedRaster(const Raster& raster, glm::bvec2 along, const LatticeBox& wanted,
                 std::pmr::memory_resource& memory);

    /// Of all pixels, also those that have no value.
    const Raster& raster() const { return halved_; }

  private:
    float* pixel(glm::ivec2 point);

    Raster halved_;
    UnclearedArray<float> values_;
    std::vector<glm::ivec2> spans_;
};

}  // namespace deltasplat
