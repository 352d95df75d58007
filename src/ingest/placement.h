// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <string>

namespace deltasplat {

/// Checks that a file's worldFromIndex gives every voxel a place of its own, in sizes that a double
/// can still tell apart.
/// @param what  "an sform", "spacing and directions"
/// @throw Error(kInput) "<where>: got <what> that give no place to voxels; expected ..."
void requirePlacement(const std::string& where, const std::string& what, const glm::dmat4& matrix);

}  // namespace deltasplat
