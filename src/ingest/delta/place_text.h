// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <string>

namespace deltasplat {

/// Returns a place as messages have it: "(1, 2, 3)".
inline std::string placeText(const glm::ivec3& v) {
    return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) +
           ")";
}

}  // namespace deltasplat
