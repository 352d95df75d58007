// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/progress.h"

namespace deltasplat {

/// A file's grid that a scene places in its world.
struct UsdVolume {
    std::filesystem::path file;  ///< empty: none is shown
    std::string grid;            ///< empty: the scene names none
    glm::dmat4 worldFromVolume{1.0};
};

/// The same at each frame.
struct UsdVolumeMotion {
    std::vector<double> frames;  ///< where it changes, ascending; empty: it stands still
    /// @throw Error(kInput) for what a volume cannot be
    std::function<UsdVolume(double frame)> at;
    std::optional<glm::dvec3> upWorld;
};

/// Reads which volume a .usda shows: of a Volume prim the field `density`, else its first one; or
/// of an OpenVDBAsset itself.
/// @param name  path of the prim; empty: the only Volume or, without one, the only OpenVDBAsset
/// @throw Error(kInput) as readUsdLayer, and for what it does not show
UsdVolumeMotion readUsdVolume(const std::filesystem::path& file, const std::string& name,
                              const Listener& listener);

}  // namespace deltasplat
