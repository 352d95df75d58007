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

/// Views whose slabs are put together, those in front first.
struct Picture::Impl {
    struct View {
        PlaneView plane;
        ErrorBound bound;
        Layer layer;        ///< finished: as PlaneView::showPart takes it
        PixelBox part;      ///< pixels that may show it
        bool coversOthers;  ///< lies behind views before it that may show something there, too
    };

    explicit Impl(const Camera& ofCamera) : camera(ofCamera) {}

    PixelBox whole() const { return {{0, 0}, camera.sizePixels}; }
    /// Adds a view whose slabs are put together.
    void add(const PlaneView& plane, const ErrorBound& bound, Layer layer, const PixelBox& part,
             bool coversOthers) {
        plane.finish(layer);
        views.push_back({plane, bound, std::move(layer), part, coversOthers});
    }
    /// Adds one behind those before it, wherever they are.
    void addBehind(const PlaneView& plane, const ErrorBound& bound, Layer layer) {
        add(plane, bound, std::move(layer), whole(), !views.empty());
    }

    Camera camera;
    KeptMemory memory;  ///< of layers
    RenderStats stats;
    std::vector<View> views;
};

}  // namespace deltasplat
