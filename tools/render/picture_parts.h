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

/// Writes pixels of a picture into an image of a part's size.
using ShowPart = std::function<void(const PixelBox& part, Image& image)>;

/// Writes such a picture.
/// @param size         of all of it
/// @param isExact      else all of it is shown once before, to know how far it may be off
/// @param fileOptions  returns how it is stored, by what is known by then
void writeInParts(const RenderCommand& command, glm::ivec2 size, const ShowPart& show, bool isExact,
                  const std::function<ImageFileOptions()>& fileOptions, const Listener& listener);

/// Renders and writes such a picture.
/// @param fileOptions  returns how it is stored, once it is known how far it may be off
/// @return what render returns, but for the image
RenderResult renderInParts(const RenderCommand& command, const PreparedScene& scene,
                           const CameraOptions& camera,
                           const std::function<ImageFileOptions(const RenderResult&)>& fileOptions,
                           const Listener& listener);

}  // namespace deltasplat
