// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "optics/color_curve.h"
#include "optics/voxel_painter.h"

namespace deltasplat {

/// A transfer function's colours as a table that is read linearly: thousands of times as fast as
/// the function, which itself is asked only near its points.
class ValueColors {
  public:
    ValueColors(const Volume& volume, const Optics& optics);

    /// Returns the scene-linear colour of a data value.
    glm::vec3 colorOf(float value) const;

  private:
    static constexpr int kSteps = 4096;
    glm::vec3 below_{0.0f};          // the colour of what is less than the first
    float first_ = 0;                // data value of the first colour, as values are
    double stepsPerUnit_ = 0;        // of data values
    std::vector<glm::vec3> colors_;  // [kSteps + 1], scene-linear
    std::vector<bool> bent_;         // [kSteps]: where the colour may bend or jump on the way
    ColorCurve curve_;
    double low_ = 0;   // data value of the function's 0
    double unit_ = 1;  // and how many its 1 is more
};

/// Returns a volume's values as gradients are taken of them: how far they are from one of them, in
/// units of the change that is half noise, half surface.
/// @param noise  that change; empty: gradientNoise
GradientScale scaledValues(const Volume& volume, double zero,
                           const std::optional<double>& noise = std::nullopt);

/// Returns a hundredth of where most values lie (bulkRange), or of where all do.
double gradientNoise(const Volume& volume);

}  // namespace deltasplat
