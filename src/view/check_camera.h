// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "deltasplat/view/camera.h"

namespace deltasplat {

/// What a camera's options may be, by themselves and beside each other.
/// @throw Error(kUsage) with what was got and what is expected
void checkCameraOptions(const CameraOptions& options);

/// @throw Error(kUsage)
[[noreturn]] void refuseCamera(const char* option, const std::string& got,
                               const std::string& expected);

bool isFinite(const glm::dvec3& v);

/// Scales to length 1, without overflow on the way.
/// @throw Error(kUsage) for what has no direction
glm::dvec3 unitVector(const char* option, const glm::dvec3& v);

}  // namespace deltasplat
