// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/progress.h"
#include "deltasplat/view/film_camera.h"

namespace deltasplat {

/// A camera that a file describes, which may move from frame to frame.
struct CameraMotion {
    /// Frames of the keys, ascending; empty: the camera stands still.
    std::vector<double> frames;
    /// Returns the camera at a frame: interpolated between two keys, constant before the first and
    /// behind the last. Deterministic and thread-safe.
    /// @throw Error(kInput) if the matrix is no camera's, such as a sheared one
    std::function<FilmCamera(double frame)> at;
    std::optional<glm::dvec3> upWorld;  ///< of the scene, if the file has it
};

/// Returns whether the name ends like a camera file's: .json, .usda, .exr.
bool isCameraName(const std::filesystem::path& file);

/// Reads a camera as described in docs/cameras.md: deltasplat's own .json, a scene in USD's text
/// format (.usda), or the metadata of a rendered picture (.exr).
/// @param name  .usda: path of the camera's prim; empty: the only one
/// @throw Error(kInput) `<file>: got X; expected Y`, with a line where there is one
CameraMotion readCamera(const std::filesystem::path& file, const std::string& name = "",
                        const Listener& listener = {});

}  // namespace deltasplat
