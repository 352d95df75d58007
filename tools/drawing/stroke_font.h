// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <string_view>
#include <vector>

namespace deltasplat {

/// Text as the strokes of a pen; lengths in units of the font's size.
struct TextStrokes {
    /// Polylines, x to the right from the text's start, y down from the base line. One point alone
    /// is a dot.
    std::vector<std::vector<glm::dvec2>> strokes;
    double width = 0;  ///< to the end of the last character
};

/// Returns the strokes of UTF-8 text; characters beyond ASCII are boxes.
TextStrokes strokesOf(std::string_view text);

}  // namespace deltasplat
