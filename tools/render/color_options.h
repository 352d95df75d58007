// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "render/render_options.h"

namespace deltasplat {

/// Declares the options of colour management.
void addColorOptions(CLI::App& app, ColorOptions& options);

/// Returns what the command's ColorOptions make.
/// @throw Error as ColorTransform's constructor
const ColorTransform& colorsOf(const RenderCommand& command);

/// @throw Error(kUsage), Error(kInput) for what is asked for where it cannot be, or what the
///        configuration does not have
void checkColors(const RenderCommand& command);

/// Warns of options that were given and change nothing.
void warnOfUnusedColorOptions(const CLI::App& app, const RenderCommand& command,
                              ProgressDisplay& display);

/// Makes light, and channels of light, what is stored of them in --colorspace, and says so in
/// `file`.
void convertColors(const RenderCommand& command, Image& image, ImageFileOptions& file);

/// Says in `file` which colours are stored.
void setColors(const RenderCommand& command, ImageFileOptions& file);

}  // namespace deltasplat
