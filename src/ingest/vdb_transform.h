// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/math/Transform.h>

#include <glm/mat4x4.hpp>

namespace deltasplat {

/// Returns the simplest OpenVDB map that is exactly this affine matrix (uniform scale, scale, ...).
openvdb::math::Transform::Ptr makeTransform(const glm::dmat4& worldFromIndex);

/// Returns the matrix of a linear map; makeTransform's comes back as it was.
glm::dmat4 matrixOf(const openvdb::math::Transform& transform);

}  // namespace deltasplat
