// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/math/Transform.h>

#include <glm/mat4x4.hpp>
#include <string>

namespace deltasplat {

/// Returns the simplest OpenVDB map that is exactly this affine matrix (uniform scale, scale, ...).
/// @throw Error(kFailed) if a voxel's volume is below 3e-15, which OpenVDB takes for 0
openvdb::math::Transform::Ptr makeTransform(const glm::dmat4& worldFromIndex);

/// Returns a map of the type named ("UniformScaleMap", ...), if that can be this matrix, otherwise
/// an "AffineMap".
openvdb::math::Transform::Ptr makeTransformOfType(const std::string& mapType,
                                                  const glm::dmat4& worldFromIndex);

/// Returns the matrix of a linear map; makeTransform's comes back as it was.
glm::dmat4 matrixOf(const openvdb::math::Transform& transform);

}  // namespace deltasplat
