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

/// A transfer function's colours as a table, thousands of times as fast as the function.
class ValueColors {
  public:
    ValueColors(const Volume& volume, const Optics& optics);

    glm::vec3 colorOf(float value) const;

  private:
    static constexpr int kSteps = 4096;
    glm::vec3 below_{0.0f};          // the colour of values below `first_`
    float first_ = 0;                // data value of the first colour, rounded to float
    double stepsPerUnit_ = 0;        // of data values
    std::vector<glm::vec3> colors_;  // [kSteps + 1], scene-linear
    std::vector<bool> bent_;         // [kSteps]: may the colour bend or jump in the step?
    ColorCurve curve_;
    double low_ = 0;   // data value of the function's 0
    double unit_ = 1;  // data units from the function's 0 to its 1
};

/// Returns a volume's values for gradients: their distances from `zero` in units of `noise`.
/// @param noise  change that is half noise, half surface; empty: gradientNoise
GradientScale scaledValues(const Volume& volume, double zero,
                           const std::optional<double>& noise = std::nullopt);

/// Returns 1/100 of most values' range (bulkRange); if 0, 1/200 of the whole range; if 0, 1.
double gradientNoise(const Volume& volume);

}  // namespace deltasplat
