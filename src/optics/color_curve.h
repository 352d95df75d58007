// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// Returns whether all points have one colour, and so all values, to the last bit.
bool hasOneColor(const TransferFunction& function);

/// The colours of a transfer function, ready to be asked for many values: points are turned once
/// into the space where colours are mixed.
class ColorCurve {
  public:
    /// @param function  has at least one colour
    explicit ColorCurve(const TransferFunction& function);

    /// As TransferFunction::colorAt.
    glm::dvec3 at(double x) const;

  private:
    // Colours from `begin` on, up to the next one's; mixed straight.
    struct Stretch {
        double begin, end;
        glm::dvec3 from, to;
    };

    void addStretch(const TransferFunction::ColorPoint& left,
                    const TransferFunction::ColorPoint& right);
    void addDiverging(double begin, double end, glm::dvec3 from, glm::dvec3 to);
    glm::dvec3 mixable(const glm::dvec3& rgb) const;
    glm::dvec3 linear(const glm::dvec3& mixed) const;

    ColorSpace space_;
    bool linearColors_;
    TransferFunction::ColorPoint first_, last_;
    std::vector<Stretch> stretches_;  // of some length each
};

}  // namespace deltasplat
