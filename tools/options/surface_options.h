// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/render_options.h"

namespace deltasplat {

/// Whether a surface is to be shown, and which, as far as that was said.
struct SurfaceChoice {
    bool asked = false;       ///< a surface, whatever the volume is
    bool ofLevelSets = true;  ///< of what turns out to be a level set
    bool isFogGiven = false;  ///< level sets were asked to be fog
    std::optional<double> isovalue;
    std::optional<glm::dvec3> color;

    /// Returns the surface of a volume, if one is to be shown.
    /// @throw Error(kUsage) if one is asked for and the volume is no level set and has no isovalue
    std::optional<Surface> of(const Volume& volume) const;
};

/// Declares the options of surfaces, and the one of opacity by gradients.
void addSurfaceOptions(CLI::App& app, SurfaceChoice& choice,
                       std::vector<glm::dvec2>& gradientOpacity);

/// Finds out what other options say of surfaces: level sets are shown as such, unless what they are
/// made of is asked for. Has `read` keep them then.
/// @param isFog  whether what is shown is to be lit fog
void applySurface(const CLI::App& app, Mode mode, bool isFog, SurfaceChoice& choice,
                  ReadOptions& read);

}  // namespace deltasplat
