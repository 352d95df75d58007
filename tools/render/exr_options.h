// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "render/render_options.h"

namespace deltasplat {

/// Declares the options that say how a picture lies in an .exr and is packed, and which part of it
/// is made.
void addExrOptions(CLI::App& app, RenderCommand& command);
/// Those of them that are about a picture that is there.
void addExrFileOptions(CLI::App& app, RenderCommand& command);

/// Sets the camera's overscan, once its size is known.
/// @throw Error(kUsage) for what is not an .exr
void applyOverscan(RenderCommand& command);

/// @throw Error(kUsage)
void checkExr(const RenderCommand& command);

/// Warns of options that were given and change nothing.
void warnOfUnusedExrOptions(const CLI::App& app, const RenderCommand& command,
                            ProgressDisplay& display);

/// Says how the picture of a camera is stored.
void setExr(const RenderCommand& command, const Camera& camera, ImageFileOptions& file);

}  // namespace deltasplat
