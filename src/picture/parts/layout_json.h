// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include "deltasplat/slabs.h"
#include "optics/hold_rule.h"
#include "picture/picture_view.h"

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

/// What a part of a picture says of itself.
struct PartHeader {
    SlabShare share;
    int firstSlab = 0;  ///< and up to lastSlab, without it, of all views one after the other
    int lastSlab = 0;
    PartNotes notes;
    Method method = Method::kAuto;
    Tolerance tolerance;
    std::string content;  ///< of what it was rendered from: the same in all parts of a picture
    PictureLayout layout;
};

std::string headerText(const PartHeader& header);
/// @throw Error(kInput), nlohmann's exceptions: for what is no header
PartHeader headerOf(const std::string& text);

/// Returns in what a part is of another picture than another one, as "`what` X" and "`what` Y";
/// empty if in nothing.
struct HeaderDifference {
    std::string got;
    std::string expected;
};
HeaderDifference differenceOf(const PartHeader& part, const PartHeader& first);

}  // namespace deltasplat
