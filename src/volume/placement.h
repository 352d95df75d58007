// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// The largest length that a place or a voxel may have; its inverse is the smallest that a voxel
/// may have.
inline constexpr double kMostLength = 1e15;

/// Returns whether worldFromIndex gives every voxel a place of its own, in sizes that a double can
/// still tell apart.
bool givesPlaces(const glm::dmat4& worldFromIndex);

/// Returns the placement of one slice with a thickness: where the volume is one voxel deep along an
/// axis that leads nowhere, that axis is at right angles to the others and `thickness` long.
glm::dmat4 withThickness(const glm::dmat4& worldFromIndex, const glm::i64vec3& dims,
                         double thickness);

/// Makes all lengths of a placement `factor` times as long.
void scaleLengths(glm::dmat4& worldFromIndex, double factor);

/// Checks that a file's worldFromIndex gives places.
/// @param what  "an sform", "spacing and directions"
/// @throw Error(kInput) "<where>: got <what> that give no place to voxels; expected ..."
void requirePlacement(const std::string& where, const std::string& what, const glm::dmat4& matrix);

/// Returns the world length of a voxel's shortest side.
inline double smallestSize(const Volume& volume) {
    const glm::dvec3 size = volume.voxelSize();
    return std::min({size.x, size.y, size.z});
}

/// Returns the name that Volume::lengthUnit has for a unit of length as files write it ("microns",
/// "µm", "Millimeter", "inch"), in any case; empty for what is no unit of length.
std::string lengthUnitNamed(const std::string& text);

/// Returns how many millimetres a unit of Volume::lengthUnit is; 0 for an unknown one.
double millimetresIn(const std::string& lengthUnit);

}  // namespace deltasplat
