// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "base/affine.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

/// Where a volume lies in the world.
struct VolumePlace {
    WorldBox box;                ///< around all voxel centres
    glm::dvec3 origin{0.0};      ///< where the centre of voxel (0, 0, 0) lies, or would
    glm::dmat3 directions{1.0};  ///< unit vectors along i, j and k, as columns
};

nlohmann::ordered_json vectorJson(const glm::dvec3& v);

VolumePlace placeOf(const Volume& volume);

/// Returns what the axes of world space mean: "LPS: x to the patient's left, ...", or "" where the
/// file names none.
std::string spaceText(const std::string& space);

/// Returns where the index axis (0..2) leads: "to the patient's left", or, oblique, "27.3 degrees
/// off the patient's left"; without a patient "along +x" and so on.
std::string directionText(const VolumePlace& place, const std::string& space, int axis);

/// Returns the members `world_box`, `origin`, `directions` (one unit vector each for i, j and k),
/// `space`, `length_unit`, `target` and `frame_width` (of a square front view), for a JSON object.
nlohmann::ordered_json placeJson(const Volume& volume);

/// Returns the options that make `render` take this camera again, whatever the volume.
std::string cameraOptionsText(const Camera& camera);

/// Returns the camera as a JSON object.
nlohmann::ordered_json cameraJson(const Camera& camera);

}  // namespace deltasplat
