// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "deltasplat/progress.h"
#include "formats/usd/usd_layer.h"

namespace deltasplat {

/// A prim and those that it stands in, the outermost first.
using UsdChain = std::vector<const UsdPrim*>;

/// Returns "/World/cam".
std::string pathOf(const UsdChain& chain);

/// Returns all prims of a type that are shown: those that `def` makes, in no class and not
/// inactive.
std::vector<UsdChain> primsOfType(const UsdLayer& layer, std::string_view type);

/// Returns the prim that a path names; empty if there is none.
UsdChain primAt(const UsdLayer& layer, std::string_view path);

/// Chooses the prim of a type that a path names or, if it is empty, the only one. The path may also
/// be that of a prim that holds only one.
/// @throw Error(kInput) naming those there are
UsdChain choosePrim(const UsdLayer& layer, std::string_view type, const std::string& path);

/// Returns a property's value at a time: the samples' on a straight line between them if they are
/// numbers, or of the one before; before the first the first one's; else the value itself. Null if
/// there is none, or it is blocked.
/// @param mixes  numbers are taken between samples
UsdValue valueAt(const UsdProperty& property, double time, bool mixes = true);

/// Returns a number, or several, of a property.
/// @throw Error(kInput) if it has a value that is something else or not finite
std::vector<double> numbersAt(const UsdLayer& layer, const UsdProperty& property, double time,
                              std::size_t count);

/// Where a prim stands: its xformOps and those of all that it stands in.
/// @throw Error(kInput) for what these cannot be
glm::dmat4 worldFromPrim(const UsdLayer& layer, const UsdChain& chain, double time);

/// Adds the times of samples that say where a prim stands.
void addTimes(const UsdChain& chain, std::vector<double>& times);
void addTimes(const UsdPrim& prim, std::string_view property, std::vector<double>& times);

/// Says what of the prims is not followed, such as references, and what moves nothing.
void warnOfUsd(const UsdLayer& layer, const UsdChain& chain, const Listener& listener);

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
