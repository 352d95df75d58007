// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "optics/hold_rule.h"
#include "picture/plane_view.h"

namespace deltasplat {

/// How the slabs of a view lie on its base plane, and what putting them together gives.
struct ViewLayout {
    PlanePlace place;
    int channels = 4;             ///< of layers: 1 where `place` has a colour
    PlaneBox reach;               ///< of all slabs
    std::vector<PlaneBox> slabs;  ///< from the front on; empty ones are out of sight
    ErrorBound bound;             ///< of what they look like together
};

/// All that a picture's slabs have to be put together by, and to be shown: plain numbers, which
/// know nothing of the volume.
struct PictureLayout {
    Camera camera;
    std::vector<ViewLayout> views;

    int slabs() const;
};

/// As JSON, every number as it is.
nlohmann::ordered_json layoutJson(const PictureLayout& layout);
/// @throw nlohmann's exceptions for what is no layout; Error(kInput) for numbers that none has
PictureLayout layoutOf(const nlohmann::ordered_json& json);

}  // namespace deltasplat
