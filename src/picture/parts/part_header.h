// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/slabs.h"
#include "picture/parts/layout_json.h"

namespace deltasplat {

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
