// SPDX-License-Identifier: Apache-2.0
#include "annotate/ink.h"

#include <algorithm>

#include "drawing/stroke_font.h"

namespace deltasplat {

double Ink::lineWidth() const {
    return std::max(1.2, 0.12 * font_);
}

double Ink::rimWidth() const {
    return std::max(0.9, 0.08 * font_);
}

double Ink::textWidth(const std::string& text) const {
    return font_ * strokesOf(text).width;
}

void Ink::line(const std::vector<glm::dvec2>& points, const Rgb& color) {
    rims_.emplace_back(Line{points, colors_.rim, lineWidth() + 2 * rimWidth()});
    shapes_.emplace_back(Line{points, color, lineWidth()});
}

void Ink::text(glm::dvec2 at, const std::string& text, Label::Anchor anchor, const Rgb& color) {
    const TextStrokes strokes = strokesOf(text);
    const double before = anchor == Label::Anchor::kStart    ? 0
                          : anchor == Label::Anchor::kMiddle ? 0.5 * strokes.width
                                                             : strokes.width;
    for (std::vector<glm::dvec2> points : strokes.strokes) {
        for (glm::dvec2& p : points) p = at + font_ * (p - glm::dvec2(before, 0));
        line(points, color);
    }
}

void Ink::area(const Area& area) {
    std::vector<glm::dvec2> around = area.points;
    around.push_back(around.front());
    rims_.emplace_back(Line{around, colors_.rim, 2 * rimWidth()});
    shapes_.emplace_back(area);
}

void Ink::frame(glm::dvec2 min, glm::dvec2 max) {
    line({min, {max.x, min.y}, max, {min.x, max.y}, min}, colors_.ink);
}

std::vector<Shape> Ink::shapes() const {
    std::vector<Shape> all = rims_;
    all.insert(all.end(), shapes_.begin(), shapes_.end());
    return all;
}

}  // namespace deltasplat
