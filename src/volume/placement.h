// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// Largest length of a place or a voxel. The smallest length of a voxel is the inverse.
inline constexpr double kMostLength = 1e15;

/// Whether worldFromIndex gives every voxel a place of its own, in sizes that doubles tell apart.
bool givesPlaces(const glm::dmat4& worldFromIndex);

/// Gives a slice a thickness. If the volume is one voxel deep along an axis of length 0, the
/// returned axis is perpendicular to the others and `thickness` long.
glm::dmat4 withThickness(const glm::dmat4& worldFromIndex, const glm::i64vec3& dims,
                         double thickness);

void scaleLengths(glm::dmat4& worldFromIndex, double factor);

/// Requires that a file's worldFromIndex gives places.
/// @param what  "an sform", "spacing and directions"
/// @throw Error(kInput) "<where>: got <what> that cannot be inverted; expected ..."
void requirePlacement(const std::string& where, const std::string& what, const glm::dmat4& matrix);

inline double smallestSize(const Volume& volume) {
    const glm::dvec3 size = volume.voxelSize();
    return std::min({size.x, size.y, size.z});
}

/// Returns the name in Volume::lengthUnit for a file's unit of length, in upper or lower case
/// ("microns", "µm", "Millimeter", "inch"). Empty if the text is no unit of length.
std::string lengthUnitNamed(const std::string& text);

/// Returns the millimetres in a unit of Volume::lengthUnit; 0 if the unit is unknown.
double millimetresIn(const std::string& lengthUnit);

}  // namespace deltasplat
