// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <string>
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

/// Returns the strokes of UTF-8 text: ASCII, letters of Western Europe with their marks, and signs
/// of units (degree, micro, squared, cubed, plus-minus, times); other characters are boxes.
TextStrokes strokesOf(std::string_view text);

/// Shortens text in its middle until its strokes are at most so wide, so that it keeps its ends; no
/// further than to two characters at each end.
std::string fittedText(const std::string& text, double width);

}  // namespace deltasplat
