// SPDX-License-Identifier: Apache-2.0
#include "optics/value_colors.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace deltasplat {

ValueColors::ValueColors(const Volume& volume, const Optics& optics) {
    const TransferFunction& function = optics.transferFunction;
    const glm::dvec2 range =
        function.normalized ? optics.range.value_or(defaultRange(volume)) : glm::dvec2(0, 1);
    const double low = function.colors.front().x;
    const double high = function.colors.back().x;
    below_ = function.colorAt(std::nextafter(low, -std::numeric_limits<double>::infinity()));
    first_ = float(range.x + low * (range.y - range.x));
    const double width = (high - low) * (range.y - range.x);
    stepsPerUnit_ = width > 0 ? kSteps / width : 0;
    for (int i = 0; i <= kSteps; ++i)
        colors_.emplace_back(function.colorAt(low + (high - low) * i / kSteps));
}

glm::vec3 ValueColors::colorOf(float value) const {
    if (value < first_) return below_;
    const double place = std::clamp((double(value) - first_) * stepsPerUnit_, 0.0, double(kSteps));
    const int step = std::min(int(place), kSteps - 1);
    return glm::mix(colors_[step], colors_[step + 1], float(place - step));
}

}  // namespace deltasplat
