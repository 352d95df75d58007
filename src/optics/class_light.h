// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec4.hpp>
#include <vector>

#include "optics/voxel_painter.h"

namespace deltasplat {

/// Voxels shine in the colours of their classes.
class ClassLight : public LookLight {
  public:
    explicit ClassLight(const ClassTable& classes);

  protected:
    void lightVoxels(const WordPlace& place, const std::uint16_t* classes, const OwnLook* looks,
                     WordUnits& colors) const override;

  private:
    std::vector<glm::vec4> colors_;  // [classes]: premultiplied
};

}  // namespace deltasplat
