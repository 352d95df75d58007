// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "base/kept_memory.h"
#include "deltasplat/slabs.h"
#include "picture/render_views.h"

namespace deltasplat {

/// The views of a picture, and their slabs in one list.
struct SlabPicture::Impl {
    /// A slab of a view that may be visible, counted from the front.
    struct Place {
        std::size_t view;
        int slab;
    };

    Impl(const PreparedScene& ofScene, const Camera& ofCamera, const Listener& listener);

    /// @throw Error(kUsage) if there is no such slab
    const Place& placeOf(int slab) const;
    const SlabInput& inputOf(const Place& place) const { return views[place.view]->slabs(); }
    const SeenSlab& seenOf(const Place& place) const {
        return seen[place.view][std::size_t(place.slab)];
    }
    /// Empty if the slab is out of sight.
    PlaneBox reachOf(const Place& place) const;
    Layer render(int slab, const Listener& listener) const;

    PreparedScene scene;
    Camera camera;
    mutable KeptMemory memory;
    std::vector<std::shared_ptr<const PreparedScene::Impl>> groups;  ///< groups that lie far apart
    std::vector<std::unique_ptr<const PictureView>> views;
    std::vector<std::vector<SeenSlab>> seen;  ///< [view]
    std::vector<Place> slabs;
};

}  // namespace deltasplat
