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
        // The longer an arrow, the better its letter's place is its own.
        std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
            return glm::length(axes_[a].along) > glm::length(axes_[b].along);
        });
        for (const int axis : order) placeLetter(axis);
        return ink_;
    }

  private:
    bool isEndOn(int axis) const { return glm::length(axes_[axis].along) < 0.2; }

    void paintArrow(int axis) {
        const glm::dvec2 along = axes_[axis].along;
        const glm::dvec2 way = glm::normalize(along);
        const glm::dvec2 aside(-way.y, way.x);
        const glm::dvec2 tip = tipOf(axis);
        const double head = std::min(0.5 * font_, 0.5 * length_ * glm::length(along));
        const Rgb& color = ink_.colors().axes[axis];
        ink_.line({origin_, tip}, color);
        ink_.line({tip - head * (way + 0.6 * aside), tip, tip - head * (way - 0.6 * aside)}, color);
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
    }

    // Puts a letter before its arrow's tip or, of an axis that is seen end-on, between the others'
    // backs; where something is there already, beside the tip; where there is no room, nowhere.
    void placeLetter(int axis) {
        glm::dvec2 from = origin_;
        glm::dvec2 away(0.0);
        if (isEndOn(axis)) {
            for (int other = 0; other < 3; ++other)
                if (other != axis) away -= axes_[other].along;
            away = 1.1 * font_ * glm::normalize(away);
        } else {
            from = tipOf(axis);
            away = 0.75 * font_ * glm::normalize(axes_[axis].along);
        }
        constexpr double kDiagonal = 0.70710678;
        for (const glm::dvec2 turn :
             {glm::dvec2(1, 0), glm::dvec2(kDiagonal, kDiagonal), glm::dvec2(kDiagonal, -kDiagonal),
              glm::dvec2(0, 1), glm::dvec2(0, -1), glm::dvec2(-kDiagonal, kDiagonal),
              glm::dvec2(-kDiagonal, -kDiagonal), glm::dvec2(-1, 0)}) {
            const glm::dvec2 middle = from + glm::dvec2(turn.x * away.x - turn.y * away.y,
                                                        turn.x * away.y + turn.y * away.x);
            if (!isFree(middle)) continue;
            letters_.push_back(middle);
            return paintLetter(axis, middle);
        }
    }

    bool isFree(const glm::dvec2& middle) const {
        for (const glm::dvec2& letter : letters_)
            if (glm::length(letter - middle) < font_) return false;
        for (int axis = 0; axis < 3; ++axis) {
            const glm::dvec2 line = tipOf(axis) - origin_;
            const double square = glm::dot(line, line);
            const double share =
                square > 0 ? std::clamp(glm::dot(middle - origin_, line) / square, 0.0, 1.0) : 0;
            if (glm::length(middle - origin_ - share * line) < 0.5 * font_) return false;
        }
        return true;
    }

    glm::dvec2 tipOf(int axis) const { return origin_ + length_ * axes_[axis].along; }

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
    std::vector<glm::dvec2> letters_;  // middles of those that are painted
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
