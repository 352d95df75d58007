// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/math/Transform.h>

#include <glm/mat4x4.hpp>
#include <iosfwd>
#include <string>

namespace deltasplat {

/// Returns the simplest OpenVDB map that is exactly this affine matrix (uniform scale, scale, ...).
/// @throw Error(kFailed) if a voxel's volume is below 3e-15, which OpenVDB takes for 0
openvdb::math::MapBase::Ptr makeMap(const glm::dmat4& worldFromIndex);
/// Whether there is such a map.
bool hasMap(const glm::dmat4& worldFromIndex);
/// Returns makeMap's, or, where there is none, the map of unit voxels: for a grid in memory, whose
/// Volume says where it lies.
openvdb::math::MapBase::Ptr makeMapIfAny(const glm::dmat4& worldFromIndex);
/// Returns a map of the type named ("UniformScaleMap", ...), if that can be this matrix, otherwise
/// what makeMapIfAny returns.
openvdb::math::MapBase::Ptr makeMapOfType(const std::string& mapType,
                                          const glm::dmat4& worldFromIndex);

/// Returns a transform of a map, as it is. It needs OpenVDB's library.
openvdb::math::Transform::Ptr transformOf(const openvdb::math::MapBase& map);

/// Whether OpenVDB has a map of the type named.
bool isMapType(const std::string& mapType);

/// Reads a map as a .vdb file has it, as Transform::read() does. It needs OpenVDB's library for a
/// frustum alone.
/// @throw an exception of OpenVDB's, or what the stream throws
openvdb::math::MapBase::Ptr readMap(std::istream& stream);

/// Returns the matrix of a linear map; makeMap's comes back as it was.
glm::dmat4 matrixOf(const openvdb::math::MapBase& map);

/// Returns the matrix of a map that places a volume.
/// @param where  for messages
/// @throw UnreadableGrid if it is not linear, Error(kInput) if it cannot be inverted
glm::dmat4 worldFromIndexOf(const openvdb::math::MapBase& map, const std::string& where);

}  // namespace deltasplat
