// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/render.h"
#include "kept_frame.h"

namespace deltasplat {

/// As `render`.
/// @param step  null unless the picture is one of a FrameChain, under kComposite
RenderResult renderFrame(const Volume& volume, const RenderOptions& options,
                         const Listener& listener, const FrameStep* step);

/// As the public one, of a scene's insides.
RenderStats renderComposite(const FrameStep& step, const PreparedScene::Impl& scene,
                            const Camera& camera, Image& image, const Listener& listener);

}  // namespace deltasplat
