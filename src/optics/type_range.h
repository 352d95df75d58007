// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>

namespace deltasplat {

/// Returns what defaultRange is of all volumes of a type; nothing if it is that of their values.
inline std::optional<glm::dvec2> rangeOfType(const std::string& type) {
    if (type == "uint8") return glm::dvec2(0, 255);
    return std::nullopt;
}

}  // namespace deltasplat
