// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

namespace deltasplat {

/// Throws unless the transform maps three-dimensional space onto itself one to one.
/// @throw Error(kInput) if an entry is not finite or the voxels have no volume
void requireInvertible(const glm::dmat4& worldFromIndex);

}  // namespace deltasplat
