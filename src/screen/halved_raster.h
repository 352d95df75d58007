// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <memory_resource>
#include <vector>

#include "base/uncleared.h"
#include "screen/warp.h"

namespace deltasplat {

struct LatticeBox {
    glm::ivec2 min;
    glm::ivec2 max;
};

/// A raster of half as many pixels along an axis or both. Pixel i lies between pixels 2 i and 2 i +
/// 1; it is 1/8, 3/8, 3/8, 1/8 of the four from 2 i - 1 on. That preserves linear ramps and mass,
/// and drops most details too fine for the halved raster.
class HalvedRaster {
  public:
    /// Converts a lattice position to the halved raster.
    static constexpr double halved(double position) { return (position - 0.5) / 2; }

    /// Multi-threaded.
    /// @param along   axes to halve
    /// @param wanted  of the halved lattice; other pixels, and pixels made of others, are undefined
    /// @param memory  for the pixels
    HalvedRaster(const Raster& raster, glm::bvec2 along, const LatticeBox& wanted,
                 std::pmr::memory_resource& memory);

    /// Includes undefined pixels.
    const Raster& raster() const { return halved_; }

  private:
    float* pixel(glm::ivec2 point);

    Raster halved_;
    UnclearedArray<float> values_;
    std::vector<glm::ivec2> spans_;
};

}  // namespace deltasplat
