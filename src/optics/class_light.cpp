// SPDX-License-Identifier: Apache-2.0
#include "optics/class_light.h"

namespace deltasplat {

ClassLight::ClassLight(const ClassTable& classes)
    : LookLight(VoxelUnits(classes, brightestOf(classes))),
      colors_(units().unitsOfClasses(classes)) {}

void ClassLight::lightVoxels(const WordPlace&, const std::uint16_t* classes, const OwnLook*,
                             WordUnits& colors) const {
    for (std::size_t n = 0; n < 64; ++n)
        for (int c = 0; c < 4; ++c) colors[std::size_t(c)][n] = colors_[classes[n]][c];
}

}  // namespace deltasplat
