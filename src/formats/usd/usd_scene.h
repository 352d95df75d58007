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

/// A prim with its ancestors, the outermost first.
using UsdChain = std::vector<const UsdPrim*>;

/// Returns the path of a prim, such as "/World/cam".
std::string pathOf(const UsdChain& chain);

/// Returns all shown prims of a type: made by `def`, outside of classes and active.
std::vector<UsdChain> primsOfType(const UsdLayer& layer, std::string_view type);

/// Returns the prim with a path; empty if it does not exist.
UsdChain primAt(const UsdLayer& layer, std::string_view path);

/// Chooses the prim of a type by its path, or the only one if the path is empty. The path may also
/// name a prim that contains only one.
/// @throw Error(kInput) with a list of the candidates
UsdChain choosePrim(const UsdLayer& layer, std::string_view type, const std::string& path);

/// Returns a property's value at a time: numbers interpolated linearly, else the sample before the
/// time (or the first one); without samples the plain value. Null if missing or blocked.
/// @param mixes  whether to interpolate numbers
UsdValue valueAt(const UsdProperty& property, double time, bool mixes = true);

/// Returns `count` numbers of a property.
/// @throw Error(kInput) if a value is no number or not finite
std::vector<double> numbersAt(const UsdLayer& layer, const UsdProperty& property, double time,
                              std::size_t count);

/// Returns a prim's placement: its xformOps combined with those of its ancestors.
/// @throw Error(kInput) if an op is invalid
glm::dmat4 worldFromPrim(const UsdLayer& layer, const UsdChain& chain, double time);

/// Adds the sample times of a prim's placement, or of one property.
void addTimes(const UsdChain& chain, std::vector<double>& times);
void addTimes(const UsdPrim& prim, std::string_view property, std::vector<double>& times);

/// Warns of what is ignored: composition arcs such as references, and ops without effect.
void warnOfUsd(const UsdLayer& layer, const UsdChain& chain, const Listener& listener);

/// A grid of a file, as placed in a scene's world.
struct UsdVolume {
    std::filesystem::path file;  ///< empty: no volume shown
    std::string grid;            ///< empty: not named by the scene
    glm::dmat4 worldFromVolume{1.0};
};

struct UsdVolumeMotion {
    std::vector<double> frames;  ///< ascending frames with changes; empty: static
    /// @throw Error(kInput) if the volume is invalid
    std::function<UsdVolume(double frame)> at;
    std::optional<glm::dvec3> upWorld;
};

/// Finds a .usda's volume: a Volume's field `density`, else its first one; or an OpenVDBAsset.
/// @param name  prim path; empty: the only Volume or, if there is none, the only OpenVDBAsset
/// @throw Error(kInput) as readUsdLayer, and if the prim shows no volume
UsdVolumeMotion readUsdVolume(const std::filesystem::path& file, const std::string& name,
                              const Listener& listener);

}  // namespace deltasplat
