// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace deltasplat {

/// A box in the world, along its axes.
struct WorldBox {
    glm::dvec3 min{0.0};
    glm::dvec3 max{0.0};
};

}  // namespace deltasplat
