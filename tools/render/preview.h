// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "render/render_options.h"

namespace deltasplat {

/// Declares --progressive.
void addPreviewOption(CLI::App& app, RenderCommand& command);

/// @throw Error(kUsage) if a preview is asked for that cannot be shown, or beside what is no file
void checkPreview(const RenderCommand& command);

/// Returns the camera of a picture that shows the same in an eighth of its pixels each way.
CameraOptions previewCamera(CameraOptions camera);

/// Returns the command that makes the preview of a picture: the same light, with nothing beside it
/// or drawn over it, and marked as one.
RenderCommand previewOf(RenderCommand command);

}  // namespace deltasplat
