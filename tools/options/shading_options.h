// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <vector>

#include "deltasplat/optics/shading.h"

namespace deltasplat {

/// How what is shown is to be lit, as far as that was said.
struct ShadingChoice {
    std::optional<bool> shades;  ///< empty: as suits what is shown, or if anything else is given
    bool isAnyGiven = false;
    bool isAmbientGiven = false;
    Shading shading;  ///< without lights: one on the camera
    std::vector<Light> lights;

    bool asked() const { return shades.value_or(isAnyGiven); }
    /// Returns the shading of a picture.
    /// @param suits  whether it is shaded if nothing was said
    std::optional<Shading> of(bool suits) const;
};

void addShadingOptions(CLI::App& app, ShadingChoice& choice);

}  // namespace deltasplat
