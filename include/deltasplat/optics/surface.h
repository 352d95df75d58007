// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace deltasplat {

struct Volume;

/// An opaque surface: where values, which change linearly from voxel to voxel, pass one value. What
/// is above it is inside; in level sets (isLevelSet) what is below.
struct Surface {
    double isovalue = 0;              ///< in data units
    glm::dvec3 color{0.6, 0.6, 0.6};  ///< scene-linear
};

/// Whether a volume's values are distances to a surface, as those of a .vdb of class level set that
/// was not turned into fog: less than 0 inside.
bool isLevelSet(const Volume& volume);

}  // namespace deltasplat
