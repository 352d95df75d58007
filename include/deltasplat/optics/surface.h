// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace deltasplat {

class Volume;

/// An opaque surface where values, linear between voxels, pass one value. Larger values are inside;
/// in level sets (isLevelSet) smaller ones.
struct Surface {
    double isovalue = 0;              ///< in data units
    glm::dvec3 color{0.6, 0.6, 0.6};  ///< scene-linear
};

/// Whether values are distances to a surface, negative inside: a .vdb level set not made fog.
bool isLevelSet(const Volume& volume);

}  // namespace deltasplat
