// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/fwd.hpp>
#include <string>

namespace deltasplat {

/// Returns lengths along each axis: "512x512", "256x256x128".
template <glm::length_t kAxes, typename T>
std::string dimsText(const glm::vec<kAxes, T>& dims, const char* times = "x") {
    std::string text;
    for (glm::length_t axis = 0; axis < kAxes; ++axis)
        text += (axis == 0 ? "" : times) + std::to_string(dims[axis]);
    return text;
}

}  // namespace deltasplat
