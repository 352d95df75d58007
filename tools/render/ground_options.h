// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "deltasplat/ground_shadow.h"
#include "render/render_options.h"

namespace deltasplat {

void addGroundOption(CLI::App& app, std::optional<GroundChoice>& choice);

/// @throw Error(kUsage) if a shadow is asked for where there is none
void checkGround(const RenderCommand& command);

/// Renders the shadow on the ground, if there is one, and puts it where it was asked for: beside
/// the picture, or behind it.
/// @param volume  as it was rendered
void addGroundShadow(const RenderCommand& command, const Volume& volume,
                     const RenderOptions& options, RenderResult& result, ImageFileOptions& image,
                     const Listener& listener);

}  // namespace deltasplat
