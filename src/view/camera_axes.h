// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "deltasplat/error.h"

namespace deltasplat {

/// A camera's placement from a matrix. The three directions are orthonormal.
struct CameraAxes {
    glm::dvec3 right{1, 0, 0};
    glm::dvec3 up{0, 1, 0};
    glm::dvec3 direction{0, 0, -1};
    glm::dvec3 positionWorld{0.0};
    double scale = 1;  ///< of the camera's lengths, > 0
};

/// Tolerance of the axes' relative lengths and of cosines: numbers of three digits leave as much.
inline constexpr double kAxesRounding = 2e-3;

/// Splits a matrix that turns, scales evenly and moves. Undoes rounding of the axes, first of the
/// line of sight, then of up.
/// @param worldFromCamera  columns; x to the right, y up, z away from the scene
/// @param what             names the faulty input in messages
/// @throw Error(code) if it is not finite, or projects, mirrors, shears, or scales to 0 or unevenly
CameraAxes cameraAxes(const glm::dmat4& worldFromCamera, const std::string& what, ErrorCode code);

}  // namespace deltasplat
