// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "annotate/ink.h"
#include "drawing/drawing.h"

namespace deltasplat {

/// A rectangle of a picture in pixels; empty where min = max.
struct DrawnBox {
    glm::dvec2 min{0.0};
    glm::dvec2 max{0.0};

    bool empty() const { return !(min.x < max.x && min.y < max.y); }
    bool overlaps(const DrawnBox& other) const;
    bool contains(const DrawnBox& other) const;
};

/// What is drawn over a part of a picture.
struct Annotation {
    std::string option;         ///< that asks for it
    std::vector<Shape> shapes;  ///< no Label among them
    DrawnBox box;               ///< beyond which no pixel changes
};

Annotation makeAnnotation(const std::string& option, const Ink& ink);

/// What all annotations of a picture share. Lengths are pixels.
struct AnnotationStyle {
    /// Readable at 256 pixels a side, and not lost at 4096.
    AnnotationStyle(glm::ivec2 sizePixels, const InkColors& inkColors);

    glm::dvec2 picture;
    double font;
    double margin;
    InkColors colors;
};

}  // namespace deltasplat
