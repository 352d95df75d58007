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
    /// Frames of its keys, ascending; empty: it stands still.
    std::vector<double> frames;
    /// Returns the camera at a frame: between two keys what lies between them, before the first
    /// and behind the last what these are. Deterministic and thread-safe.
    /// @throw Error(kInput) if it is none there, such as one that is sheared
    std::function<FilmCamera(double frame)> at;
    std::optional<glm::dvec3> upWorld;  ///< of the scene, if the file says so
};

/// Returns whether the name ends as those of files that readCamera reads: .json, .usda, .exr.
bool isCameraName(const std::filesystem::path& file);

/// Reads a camera as docs/cameras.md has it: from deltasplat's own .json, from a scene in USD's
/// text format (.usda), or from what a renderer has noted in a picture (.exr).
/// @param name  of a .usda: path of the prim of the camera; empty: the only one
/// @throw Error(kInput) `<file>: got X; expected Y`, with a line where there is one
CameraMotion readCamera(const std::filesystem::path& file, const std::string& name = "",
                        const Listener& listener = {});

}  // namespace deltasplat
