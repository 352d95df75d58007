// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>

namespace deltasplat {

/// Returns the shortest text that reads back as the same number, whatever the locale.
inline std::string numberText(double number) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

/// Returns "x,y", as options are written.
inline std::string numberText(const glm::dvec2& v) {
    return numberText(v.x) + "," + numberText(v.y);
}

/// Returns "x,y,z", as options are written.
inline std::string numberText(const glm::dvec3& v) {
    return numberText(glm::dvec2(v)) + "," + numberText(v.z);
}

}  // namespace deltasplat
