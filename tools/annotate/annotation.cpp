// SPDX-License-Identifier: Apache-2.0
#include "annotate/annotation.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace deltasplat {
namespace {

// Adds what points may cover, `margin` wider.
void grow(DrawnBox& box, const std::vector<glm::dvec2>& points, double margin) {
    for (const glm::dvec2& p : points) {
        const bool first = box.empty();
        box.min = first ? p - margin : glm::min(box.min, p - margin);
        box.max = first ? p + margin : glm::max(box.max, p + margin);
    }
}

}  // namespace

bool DrawnBox::overlaps(const DrawnBox& other) const {
    return min.x < other.max.x && other.min.x < max.x && min.y < other.max.y && other.min.y < max.y;
}

bool DrawnBox::contains(const DrawnBox& other) const {
    return min.x <= other.min.x && min.y <= other.min.y && other.max.x <= max.x &&
           other.max.y <= max.y;
}

Annotation makeAnnotation(const std::string& option, const Ink& ink) {
    Annotation annotation{option, ink.shapes(), {}};
    DrawnBox box;
    for (const Shape& shape : annotation.shapes) {
        // Half a pixel more than a line's half width is covered in part.
        if (const Line* const line = std::get_if<Line>(&shape))
            grow(box, line->points, 0.5 * line->width + 1);
        if (const Area* const area = std::get_if<Area>(&shape)) grow(box, area->points, 1e-6);
    }
    annotation.box = {glm::floor(box.min), glm::ceil(box.max)};
    return annotation;
}

AnnotationStyle::AnnotationStyle(glm::ivec2 sizePixels, const InkColors& inkColors)
    : picture(sizePixels), colors(inkColors) {
    constexpr double kLeastFont = 10;
    font = std::max(kLeastFont, std::min(picture.x, picture.y) / 38);
    margin = std::round(font);
}

}  // namespace deltasplat
