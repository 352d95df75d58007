// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "deltasplat/error.h"

namespace deltasplat {

/// What a matrix says of a camera. The three directions are orthonormal.
struct CameraAxes {
    glm::dvec3 right{1, 0, 0};
    glm::dvec3 up{0, 1, 0};
    glm::dvec3 direction{0, 0, -1};
    glm::dvec3 positionWorld{0.0};
    double scale = 1;  ///< of lengths that the camera has, > 0
};

/// By how much axes may differ in length, and the cosine of angles between them be other than 0:
/// what numbers of three digits leave.
inline constexpr double kAxesRounding = 2e-3;

/// Takes a matrix apart that turns, scales evenly and moves; what rounding has done to the axes is
/// undone, first of the line of sight, then of up.
/// @param worldFromCamera  of points as columns: x to the right, y up, z away from what is seen
/// @param what             is wrong, for messages
/// @throw Error(code) if it is not finite, projects, or is singular, mirrored, sheared or unevenly
///        scaled
CameraAxes cameraAxes(const glm::dmat4& worldFromCamera, const std::string& what, ErrorCode code);

}  // namespace deltasplat
