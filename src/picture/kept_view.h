// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "composite/layer.h"
#include "deltasplat/image/pixel_box.h"
#include "picture/picture_view.h"

namespace deltasplat {

/// A view of a picture and what its slabs look like together, ready to be shown.
struct KeptView {
    std::unique_ptr<const PictureView> picture;
    Layer layer;
    /// Where voxels lie far apart: the group that it shows, and the pixels that may show it; it
    /// goes behind views before it.
    std::shared_ptr<const PreparedScene::Impl> group = nullptr;
    PixelBox part{};
};

/// As renderComposite, but for the warp: what it would show.
/// @param camera,memory  which views refer to
RenderStats renderKept(const PreparedScene::Impl& scene, const Camera& camera, KeptMemory& memory,
                       std::vector<KeptView>& views, const Listener& listener);

}  // namespace deltasplat
