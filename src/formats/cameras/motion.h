// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/mat4x4.hpp>
#include <string>

#include "deltasplat/cameras/read_camera.h"

namespace deltasplat {

/// A number's place among ascending keys: the fraction `share` of the way from key `first` to the
/// next. Beyond either end, the end key with share 0.
struct KeyPlace {
    std::size_t first = 0;
    double share = 0;
};
KeyPlace keyPlace(const std::vector<double>& keys, double at);

/// Interpolates two cameras: lengths and positions linearly, rotations along the shorter arc at
/// constant speed (K. Shoemake, "Animating Rotation with Quaternion Curves", 1985).
/// @param share  0 returns `a` itself
FilmCamera mixed(const FilmCamera& a, const FilmCamera& b, double share);
/// Interpolates two matrices that consist of rotation, uniform scale and translation.
glm::dmat4 mixed(const glm::dmat4& a, const glm::dmat4& b, double share);

/// Returns a rotation about x, y and z by the right-hand rule; quarter turns are exact.
/// @param order  the axes in the order of their rotations: "xyz", "zxy", ...
glm::dmat4 rotation(const glm::dvec3& degrees, const std::string& order);

/// Whether the text is one of the six orders of three axes.
bool isRotationOrder(const std::string& order);

/// Readers for one format each; see readCamera.
CameraMotion readJsonCamera(const std::filesystem::path& file);
CameraMotion readUsdCamera(const std::filesystem::path& file, const std::string& name,
                           const Listener& listener);
CameraMotion readExrCamera(const std::filesystem::path& file, const Listener& listener);

}  // namespace deltasplat
