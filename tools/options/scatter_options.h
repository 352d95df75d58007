// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "deltasplat/optics/scattering.h"
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

    bool asked() const { return scatters.value_or(isAnyGiven); }
    /// Returns how the picture's fog scatters, if it does.
    /// @param shading  says which lights there are, and how much light comes from everywhere
    std::optional<Scattering> of(const ShadingChoice& shading) const;
};

void addScatterOptions(CLI::App& app, ScatterChoice& choice);

}  // namespace deltasplat
