// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/math/Transform.h>

#include <glm/mat4x4.hpp>
#include <iosfwd>
#include <string>

namespace deltasplat {

/// Returns the simplest OpenVDB map that equals this affine matrix (uniform scale, scale, ...).
/// @throw Error(kFailed) if a voxel's volume is below 3e-15, which OpenVDB takes for 0
openvdb::math::MapBase::Ptr makeMap(const glm::dmat4& worldFromIndex);
/// Whether makeMap succeeds.
bool hasMap(const glm::dmat4& worldFromIndex);
/// Like makeMap, but returns the map of unit voxels if there is none: for a grid in memory, whose
/// Volume has the matrix.
openvdb::math::MapBase::Ptr makeMapIfAny(const glm::dmat4& worldFromIndex);
/// Returns a map of this type ("UniformScaleMap", ...) if it fits the matrix, else makeMapIfAny's.
openvdb::math::MapBase::Ptr makeMapOfType(const std::string& mapType,
                                          const glm::dmat4& worldFromIndex);

/// Returns a transform with exactly this map. Needs OpenVDB's library.
openvdb::math::Transform::Ptr transformOf(const openvdb::math::MapBase& map);

bool isMapType(const std::string& mapType);

/// Reads a map of a .vdb file like Transform::read(). Needs OpenVDB's library only for a frustum.
/// @throw an exception of OpenVDB or of the stream
openvdb::math::MapBase::Ptr readMap(std::istream& stream);

/// Returns the matrix of a linear map, for a map of makeMap exactly the original.
glm::dmat4 matrixOf(const openvdb::math::MapBase& map);

/// Returns the matrix of a map that places a volume.
/// @param where  for messages
/// @throw UnreadableGrid if the map is not linear; Error(kInput) if it cannot be inverted
glm::dmat4 worldFromIndexOf(const openvdb::math::MapBase& map, const std::string& where);

}  // namespace deltasplat
