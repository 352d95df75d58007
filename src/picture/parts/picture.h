// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "base/kept_memory.h"
#include "composite/layer.h"
#include "deltasplat/picture.h"
#include "optics/hold_rule.h"
#include "picture/picture_view.h"

namespace deltasplat {

/// Views with merged slabs, from front to back.
struct Picture::Impl {
    struct View {
        PlaneView plane;
        ErrorBound bound;
        Layer layer;        ///< finished (PlaneView::finish)
        PixelBox part;      ///< pixels that may show the view
        bool coversOthers;  ///< whether earlier views may show something there, too
    };

    explicit Impl(const Camera& ofCamera) : camera(ofCamera) {}

    PixelBox whole() const { return {{0, 0}, camera.sizePixels}; }
    void add(const PlaneView& plane, const ErrorBound& bound, Layer layer, const PixelBox& part,
             bool coversOthers) {
        plane.finish(layer);
        views.push_back({plane, bound, std::move(layer), part, coversOthers});
    }
    /// Adds a view behind all earlier ones.
    void addBehind(const PlaneView& plane, const ErrorBound& bound, Layer layer) {
        add(plane, bound, std::move(layer), whole(), !views.empty());
    }

    Camera camera;
    KeptMemory memory;  ///< for layers
    RenderStats stats;
    std::vector<View> views;
};

}  // namespace deltasplat
