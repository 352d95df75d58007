// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <vector>

#include "render/render_options.h"

namespace deltasplat {

/// Declares the option that says which channels are wanted beside a picture's own.
void addAovOption(CLI::App& app, std::vector<Aov>& aovs);

/// Refuses channels where there can be none.
/// @throw Error(kUsage)
void checkAovs(const RenderCommand& command);

/// Says that depths are by what hides something, and fire hides nothing.
void warnOfDepths(const std::vector<Aov>& aovs, const Optics& optics, const Listener& listener);

}  // namespace deltasplat
