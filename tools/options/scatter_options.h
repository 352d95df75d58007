// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/optics/scattering.h"
#include "deltasplat/optics/sky.h"
#include "listener.h"
#include "options/shading_options.h"

namespace deltasplat {

/// How fog is to scatter light, as far as that was said.
struct ScatterChoice {
    std::optional<bool> scatters;  ///< empty: if anything below is given
    bool isAnyGiven = false;
    Scattering scattering;  ///< without lights and lobes
    /// Both lobes' anisotropy, and the share of the second.
    struct Lobes {
        double first = 0;
        double second = 0;
        double share = 0;
    } lobes;

    /// The way towards the sun, and how bright it is; empty: no sky.
    struct SunPlace {
        glm::dvec3 towards{0.0};
        double strength = 1;
    };
    std::optional<SunPlace> sky;
    double turbidity = Sky{}.turbidity;
    std::filesystem::path environment;  ///< empty: none
    double environmentStrength = 1;
    double environmentTurnDegrees = 0;  ///< about what is up
    int environmentLights = 32;         ///< that the sky and the environment are cut into, each

    bool asked() const { return scatters.value_or(isAnyGiven); }
    /// Returns how the picture's fog scatters, if it does.
    /// @param shading  says which lights there are besides, and how much light comes from
    ///                 everywhere
    /// @param isLitBesides  whether there will be yet others, so that no sky is needed
    /// @param up       of the world
    /// @throw Error for an environment that cannot be read
    std::optional<Scattering> of(const ShadingChoice& shading, bool isLitBesides,
                                 const glm::dvec3& up, const Listener& listener) const;

  private:
    std::vector<Light> lights(const ShadingChoice& shading, bool isLitBesides, const glm::dvec3& up,
                              const Listener& listener) const;
};

void addScatterOptions(CLI::App& app, ScatterChoice& choice);

/// The options that addScatterOptions declares.
std::vector<std::string> scatterOptions();

/// Warns of options that were given and change nothing, as others say how the picture is lit.
/// @param shading,isLitBesides  say which lights there are besides
void warnOfUnusedScatterOptions(const CLI::App& app, const ScatterChoice& choice,
                                const ShadingChoice& shading, bool isLitBesides,
                                ProgressDisplay& display);

}  // namespace deltasplat
