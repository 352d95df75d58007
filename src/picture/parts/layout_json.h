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

/// How the slabs of a view lie on its base plane, and what they show together.
struct ViewLayout {
    PlanePlace place;
    int channels = 4;             ///< of layers: 1 if `place` has a color
    PlaneBox reach;               ///< of all slabs
    std::vector<PlaneBox> slabs;  ///< from front to back; empty if out of sight
    ErrorBound bound;             ///< of all slabs together
};

/// All that is needed to merge and show a picture's slabs: plain numbers, without the volume.
struct PictureLayout {
    Camera camera;
    std::vector<ViewLayout> views;

    int slabs() const;
};

/// Returns JSON with exact numbers.
nlohmann::ordered_json layoutJson(const PictureLayout& layout);
/// @throw nlohmann's exceptions for malformed JSON; Error(kInput) for impossible numbers
PictureLayout layoutOf(const nlohmann::ordered_json& json);

/// The header of a part of a picture.
struct PartHeader {
    SlabShare share;
    int firstSlab = 0;  ///< of [firstSlab, lastSlab), counted through all views
    int lastSlab = 0;
    PartNotes notes;
    Method method = Method::kAuto;
    Tolerance tolerance;
    std::string content;  ///< digest of the rendered data, equal in all parts of a picture
    PictureLayout layout;
};

std::string headerText(const PartHeader& header);
/// @throw Error(kInput), nlohmann's exceptions: for malformed headers
PartHeader headerOf(const std::string& text);

/// A difference of two parts' pictures, as "`what` X" and "`what` Y"; empty if there is none.
struct HeaderDifference {
    std::string got;
    std::string expected;
};
HeaderDifference differenceOf(const PartHeader& part, const PartHeader& first);

}  // namespace deltasplat
