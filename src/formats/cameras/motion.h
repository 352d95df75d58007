// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/mat4x4.hpp>
#include <string>

#include "deltasplat/cameras/read_camera.h"

namespace deltasplat {

/// Where a number lies in a row of ascending ones: between `first` and `first + 1`, `share` of the
/// way; before the first and behind the last at these, with a share of 0.
struct KeyPlace {
    std::size_t first = 0;
    double share = 0;
};
KeyPlace keyPlace(const std::vector<double>& keys, double at);

/// Returns what lies between two cameras: lengths and positions on straight lines, rotations on the
/// shorter arc at a steady pace (K. Shoemake, "Animating Rotation with Quaternion Curves", 1985).
/// @param share  0 returns `a` itself
FilmCamera mixed(const FilmCamera& a, const FilmCamera& b, double share);
/// The same of matrices that turn, scale evenly and move.
glm::dmat4 mixed(const glm::dmat4& a, const glm::dmat4& b, double share);

/// Returns a rotation about the axes x, y and z, in degrees, by the right-hand rule; quarter turns
/// are exact.
/// @param order  which axis comes first: "xyz", "zxy", ...
glm::dmat4 rotation(const glm::dvec3& degrees, const std::string& order);

/// Returns whether it is one of the six orders of three axes.
bool isRotationOrder(const std::string& order);

/// As readCamera, of one format each.
CameraMotion readJsonCamera(const std::filesystem::path& file);
CameraMotion readUsdCamera(const std::filesystem::path& file, const std::string& name,
                           const Listener& listener);
CameraMotion readExrCamera(const std::filesystem::path& file, const Listener& listener);

}  // namespace deltasplat
