// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render/render_options.h"

namespace deltasplat {

/// Whether the picture is written as an .exr.
bool isExr(const RenderCommand& command);

/// Whether the mode shows values of voxels, or of what is between, which have colours.
bool colorsValues(const RenderCommand& command);

/// Whether the picture is to hold values instead of light: all modes but composite, in a format of
/// floats.
bool storesValues(const RenderCommand& command);

/// @throw Error(kUsage) for a picture of numbers that its format cannot place
void checkNumbers(const RenderCommand& command);

/// Whether the picture is to show values as greys.
bool showsWindow(const RenderCommand& command);

/// Returns the values of black and white that were asked for: --window or, unless values are added
/// up, --range. Empty: neither.
std::optional<glm::dvec2> windowAsked(const RenderCommand& command);

/// Sets what follows from mode and file format: values are stored as 32-bit floats, and formats of
/// 8 or 16 bits show the transfer function's colours of values, if one is given.
/// @throw Error(kUsage) if two modes are asked for
void applyMode(const CLI::App& app, RenderCommand& command);

/// Warns of options that were given and that have no effect in the mode that was.
void warnOfUnusedModeOptions(const CLI::App& app, const RenderCommand& command,
                             ProgressDisplay& display);

}  // namespace deltasplat
