// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <string>

namespace deltasplat {

/// The largest length that a place or a voxel may have; its inverse is the smallest that a voxel
/// may have.
inline constexpr double kMostLength = 1e15;

/// Returns whether worldFromIndex gives every voxel a place of its own, in sizes that a double can
/// still tell apart.
bool givesPlaces(const glm::dmat4& worldFromIndex);

/// Checks that a file's worldFromIndex gives places.
/// @param what  "an sform", "spacing and directions"
/// @throw Error(kInput) "<where>: got <what> that give no place to voxels; expected ..."
void requirePlacement(const std::string& where, const std::string& what, const glm::dmat4& matrix);

}  // namespace deltasplat
