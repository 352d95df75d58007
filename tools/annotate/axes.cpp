// SPDX-License-Identifier: Apache-2.0
#include "annotate/axes.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <vector>

namespace deltasplat {
namespace {

class AxesPainter {
  public:
    AxesPainter(const std::array<SeenAxis, 3>& axes, const AnnotationStyle& style)
        : axes_(axes),
          font_(style.font),
          length_(2.4 * style.font),
          origin_(style.margin + length_ + 1.2 * font_,
                  style.picture.y - style.margin - length_ - 1.2 * font_),
          ink_(style.font, style.colors) {}

    Ink paint() {
        std::array<int, 3> order{0, 1, 2};
        std::stable_sort(order.begin(), order.end(),
                         [&](int a, int b) { return axes_[a].away > axes_[b].away; });
        for (const int axis : order) isEndOn(axis) ? paintEndOn(axis) : paintArrow(axis);
        return ink_;
    }

  private:
    bool isEndOn(int axis) const { return glm::length(axes_[axis].along) < 0.2; }

    void paintArrow(int axis) {
        const glm::dvec2 along = axes_[axis].along;
        const glm::dvec2 way = glm::normalize(along);
        const glm::dvec2 aside(-way.y, way.x);
        const glm::dvec2 tip = origin_ + length_ * along;
        const double head = std::min(0.5 * font_, 0.5 * length_ * glm::length(along));
        const Rgb& color = ink_.colors().axes[axis];
        ink_.line({origin_, tip}, color);
        ink_.line({tip - head * (way + 0.6 * aside), tip, tip - head * (way - 0.6 * aside)}, color);
        paintLetter(axis, tip + 0.75 * font_ * way);
    }

    void paintEndOn(int axis) {
        const double size = 0.28 * font_;
        const Rgb& color = ink_.colors().axes[axis];
        if (axes_[axis].away > 0) {
            ink_.line({origin_ - size, origin_ + size}, color);
            ink_.line({origin_ + glm::dvec2(size, -size), origin_ + glm::dvec2(-size, size)},
                      color);
        } else {
            std::vector<glm::dvec2> disc;
            for (const glm::dvec2 p :
                 {glm::dvec2(1, 0), glm::dvec2(0.7, 0.7), glm::dvec2(0, 1), glm::dvec2(-0.7, 0.7),
                  glm::dvec2(-1, 0), glm::dvec2(-0.7, -0.7), glm::dvec2(0, -1),
                  glm::dvec2(0.7, -0.7)})
                disc.push_back(origin_ + size * p);
            ink_.area({disc, color, 1});
        }
        // Between the others' backs.
        glm::dvec2 others(0.0);
        for (int other = 0; other < 3; ++other)
            if (other != axis) others += axes_[other].along;
        paintLetter(axis, origin_ - 1.1 * font_ * glm::normalize(others));
    }

    void paintLetter(int axis, const glm::dvec2& middle) {
        constexpr double kHalfCapital = 0.36;
        ink_.text(middle + glm::dvec2(0, kHalfCapital * font_), axes_[axis].letter,
                  Label::Anchor::kMiddle, ink_.colors().axes[axis]);
    }

    const std::array<SeenAxis, 3>& axes_;
    double font_;
    double length_;
    glm::dvec2 origin_;
    Ink ink_;
};

}  // namespace

std::array<SeenAxis, 3> seenAxes(const Camera& camera, const std::string& space) {
    const std::string letters = space.size() == 3 ? space : "xyz";
    std::array<SeenAxis, 3> axes;
    for (int axis = 0; axis < 3; ++axis) {
        axes[axis] = {letters.substr(std::size_t(axis), 1),
                      {camera.right[axis], -camera.up[axis]},
                      camera.direction[axis]};
    }
    return axes;
}

Annotation drawAxes(const std::array<SeenAxis, 3>& axes, const AnnotationStyle& style) {
    return makeAnnotation("--axes", AxesPainter(axes, style).paint());
}

}  // namespace deltasplat
