// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "drawing/drawing.h"

namespace deltasplat {

/// Colours that are seen on one kind of ground, and by their rim on any.
struct InkColors {
    Rgb ink;
    Rgb rim;
    Rgb quiet;
    std::array<Rgb, 3> axes;
};
inline constexpr InkColors kInkOnDark{{250, 250, 250},
                                      {0, 0, 0},
                                      {150, 150, 150},
                                      {{{255, 96, 88}, {120, 224, 104}, {112, 176, 255}}}};
inline constexpr InkColors kInkOnLight{
    {0, 0, 0}, {255, 255, 255}, {120, 120, 120}, {{{200, 24, 16}, {16, 128, 16}, {24, 72, 208}}}};

/// Collects shapes with a rim. All lengths are pixels.
class Ink {
  public:
    /// @param fontSize  of the picture's annotations, by which lines and rims have their widths
    Ink(double fontSize, const InkColors& colors) : font_(fontSize), colors_(colors) {}

    const InkColors& colors() const { return colors_; }
    void text(glm::dvec2 at, const std::string& text, Label::Anchor anchor, const Rgb& color);
    void text(glm::dvec2 at, const std::string& words,
              Label::Anchor anchor = Label::Anchor::kStart) {
        text(at, words, anchor, colors_.ink);
    }
    void line(const std::vector<glm::dvec2>& points, const Rgb& color);
    void area(const Area& area);
    /// Adds one without a rim.
    void plainArea(const Area& area) { shapes_.emplace_back(area); }
    /// Adds a line around a rectangle, half of it inside.
    void frame(glm::dvec2 min, glm::dvec2 max);

    /// Returns all that were added, rims behind everything else.
    std::vector<Shape> shapes() const;

    double textWidth(const std::string& text) const;
    double lineWidth() const;

  private:
    double rimWidth() const;

    double font_;
    InkColors colors_;
    std::vector<Shape> rims_;
    std::vector<Shape> shapes_;
};

}  // namespace deltasplat
