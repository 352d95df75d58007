// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <string>
#include <variant>
#include <vector>

#include "deltasplat/image/image.h"

namespace deltasplat {

/// An sRGB colour.
struct Rgb {
    std::uint8_t r = 0;
    std::uint8_t g = 0;
    std::uint8_t b = 0;
};

/// A polygon, filled evenly; it may not cross itself.
struct Area {
    std::vector<glm::dvec2> points;
    Rgb color;
    double opacity = 1;  ///< 0..1
};

/// A polyline with round ends and joints.
struct Line {
    std::vector<glm::dvec2> points;
    Rgb color;
    double width = 1;
};

/// One line of text.
struct Label {
    enum class Anchor { kStart, kMiddle, kEnd };
    glm::dvec2 at{0.0};  ///< start, middle or end of the base line
    std::string text;    ///< UTF-8; what is not is shown as "?"
    double size = 12;    ///< of the font
    Rgb color;
    Anchor anchor = Anchor::kStart;
    bool bold = false;
    bool upwards = false;  ///< runs from the bottom to the top
};

using Shape = std::variant<Area, Line, Label>;

/// What a picture of lines, areas and text consists of, from back to front, on white. Lengths are
/// pixels at scale 1; x to the right, y down.
struct Drawing {
    glm::dvec2 size{0.0};
    std::vector<Shape> items;
};

/// Returns an SVG 1.1 document. The same drawing gives the same bytes.
std::string svgText(const Drawing& drawing);

/// Returns an opaque picture at `scale` > 0 pixels a unit. Needs no font: text is drawn with
/// strokes of our own, see strokesOf. The same drawing gives the same pixels.
/// @throw Error(kFailed) if it does not fit into memory
Image rasterize(const Drawing& drawing, double scale);

/// Lays what a drawing consists of over a picture, whose light is mixed with the shapes' where they
/// cover a part of a pixel; what reaches beyond the picture is left out.
void drawOver(Image& image, const std::vector<Shape>& shapes, double scale = 1);

}  // namespace deltasplat
