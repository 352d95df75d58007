// SPDX-License-Identifier: Apache-2.0
#include "annotate/legend.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "drawing/nice_step.h"
#include "drawing/shapes.h"
#include "drawing/stroke_font.h"

namespace deltasplat {
namespace {

constexpr double kHalfDigit = 0.36;  // of the font's size

class LegendPainter {
  public:
    explicit LegendPainter(const AnnotationStyle& style)
        : style_(style),
          font_(style.font),
          right_(style.picture.x - style.margin),
          top_(std::round(style.margin + 1.9 * font_)),
          room_(style.picture.y - style.margin - 2.5 * font_ - top_),
          ink_(font_, style.colors) {}

    Ink paint(const Legend& legend) {
        ink_.text({right_, style_.margin + 0.8 * font_}, fitted(legend.title), Label::Anchor::kEnd);
        std::visit([&](const auto& key) { paintKey(key); }, legend.key);
        return ink_;
    }

  private:
    // No words take more than two fifths of the picture's width.
    std::string fitted(const std::string& text) const {
        return fittedText(text, 0.4 * style_.picture.x / font_);
    }

    void paintKey(const ValueScale& scale) {
        const double height =
            std::round(std::max(6 * font_, std::min(0.4 * style_.picture.y, room_)));
        const glm::dvec2 range = scale.range;
        const std::vector<double> ticks =
            niceTicks(range.x, range.y, std::max(2, int(height / (4 * font_))));
        double widest = 0;
        for (const double value : ticks)
            widest = std::max(widest, ink_.textWidth(numberText(value)));
        const double barRight = std::round(right_ - widest - 0.7 * font_);
        const double barLeft = barRight - std::round(1.1 * font_);
        for (const double value : ticks) {
            const double y = top_ + height * (range.y - value) / (range.y - range.x);
            ink_.line({{barRight, y}, {barRight + 0.35 * font_, y}}, ink_.colors().ink);
            ink_.text({right_, y + kHalfDigit * font_}, numberText(value), Label::Anchor::kEnd);
        }
        paintBar(scale, barLeft, barRight, height);
    }

    // A row of pixels each; upwards values grow, to the left opacities.
    void paintBar(const ValueScale& scale, double left, double right, double height) {
        ink_.frame({left, top_}, {right, top_ + height});
        const Rgb& quiet = ink_.colors().quiet;
        std::vector<glm::dvec2> curve;
        for (int row = 0; row < int(height); ++row) {
            const double y = top_ + row;
            const double share = (row + 0.5) / height;
            const double value = std::lerp(scale.range.y, scale.range.x, share);
            ink_.plainArea(rectangle({left, y}, {right, y + 1}, scale.colorOf(value)));
            if (!scale.opacityOf) continue;
            const double reach = 2 * font_ * opacityHeight(scale.opacityOf(value));
            ink_.plainArea(rectangle({left - reach, y}, {left, y + 1}, quiet));
            curve.emplace_back(left - reach, y + 0.5);
        }
        if (scale.opacityOf) ink_.line(curve, quiet);
    }

    void paintKey(const std::vector<LabelColor>& labels) {
        const double rowHeight = 1.5 * font_;
        const auto rows = std::size_t(std::max(1.0, std::floor(room_ / rowHeight)));
        const bool all = labels.size() <= rows;
        const std::size_t shown = all ? labels.size() : rows - 1;
        std::vector<std::string> names;
        for (std::size_t i = 0; i < shown; ++i) names.push_back(fitted(labels[i].name));
        if (!all) names.push_back("and " + std::to_string(labels.size() - shown) + " more");
        double widest = 0;
        for (const std::string& name : names) widest = std::max(widest, ink_.textWidth(name));
        const double left = std::round(right_ - widest - 1.6 * font_);
        for (std::size_t i = 0; i < names.size(); ++i) {
            const glm::dvec2 corner(left, std::round(top_ + rowHeight * double(i)));
            if (i < shown) paintSwatch(corner, labels[i].color);
            ink_.text({left + 1.6 * font_, corner.y + 0.86 * font_}, names[i]);
        }
    }

    void paintSwatch(const glm::dvec2& corner, const Rgb& color) {
        const glm::dvec2 other = corner + std::round(font_);
        ink_.frame(corner, other);
        ink_.plainArea(rectangle(corner, other, color));
    }

    const AnnotationStyle& style_;
    double font_;
    double right_;
    double top_;   // of what is below the title
    double room_;  // below it, above what may be in the lower corner
    Ink ink_;
};

}  // namespace

Annotation drawLegend(const Legend& legend, const AnnotationStyle& style) {
    return makeAnnotation("--legend", LegendPainter(style).paint(legend));
}

}  // namespace deltasplat
