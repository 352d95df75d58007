// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/optics/medium.h"
#include "listener.h"

namespace deltasplat {

/// A grid of a medium and how it is shown.
struct LayerChoice {
    std::string grid;
    std::filesystem::path transferFunction;  ///< FILE or PRESET; empty: as fire

    bool isFire() const { return transferFunction.empty(); }
    bool isFog() const { return !isFire(); }
};

/// Which grids are shown besides the volume, and how, as far as that was said.
struct MediumChoice {
    std::optional<std::string> emissionGrid;  ///< "auto": by its name
    std::filesystem::path emissionFunction;   ///< empty: black bodies
    std::optional<glm::dvec2> emissionRange;
    double emissionStrength = 1;
    /// Of values: kelvin = x * value + y; empty: as values suggest.
    std::optional<glm::dvec2> kelvin;
    /// Point lights that what shines is cut into, to light the fog; empty: it lights nothing.
    std::optional<int> emissionLights;
    std::optional<std::string> colorGrid;  ///< "auto": by its name; of floats "R,G,B"
    /// All grids, of which the volume is taken out when it is known; empty: the volume and those
    /// above.
    std::vector<LayerChoice> layers;

    bool isLayered = false;  ///< layers were given, of which the volume was taken out

    bool asked() const { return emissionGrid || colorGrid || isLayered || !layers.empty(); }
    /// Whether anything is shown as fire.
    bool burns() const;
};

void addMediumOptions(CLI::App& app, MediumChoice& choice);

/// Warns of options that were given and change nothing.
void warnOfUnusedMediumOptions(const CLI::App& app, const MediumChoice& choice,
                               ProgressDisplay& display);

/// The options that addMediumOptions declares.
std::vector<std::string> mediumOptions();

}  // namespace deltasplat
