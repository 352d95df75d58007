// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"
#include "render/render_options.h"

namespace deltasplat {

/// Whether a picture is made and written some rows at a time: light alone in an .exr, of which only
/// a region is wanted, or which is large.
bool isMadeInParts(const RenderCommand& command, const CameraOptions& camera);

/// Renders and writes such a picture.
/// @param fileOptions  returns how it is stored, once it is known how far it may be off
/// @return what render returns, but for the image
RenderResult renderInParts(const RenderCommand& command, const PreparedScene& scene,
                           const CameraOptions& camera,
                           const std::function<ImageFileOptions(const RenderResult&)>& fileOptions,
                           const Listener& listener);

}  // namespace deltasplat
