// SPDX-License-Identifier: Apache-2.0
#include "optics/value_colors.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "deltasplat/optics/default_ramp.h"
#include "optics/check_optics.h"
#include "volume/code_counts.h"

namespace deltasplat {

namespace {

const Optics& checked(const Optics& optics) {
    checkOptics(optics);
    return optics;
}

}  // namespace

ValueColors::ValueColors(const Volume& volume, const Optics& optics)
    : bent_(kSteps), curve_(checked(optics).transferFunction) {
    const TransferFunction& function = optics.transferFunction;
    const glm::dvec2 range =
        function.normalized ? optics.range.value_or(defaultRange(volume)) : glm::dvec2(0, 1);
    const double low = function.colors.front().x;
    const double high = function.colors.back().x;
    below_ = curve_.at(std::nextafter(low, -std::numeric_limits<double>::infinity()));
    first_ = float(range.x + low * (range.y - range.x));
    const double width = (high - low) * (range.y - range.x);
    stepsPerUnit_ = width > 0 ? kSteps / width : 0;
    for (int i = 0; i <= kSteps; ++i)
        colors_.emplace_back(curve_.at(low + (high - low) * i / kSteps));
    low_ = range.x;
    unit_ = range.y - range.x;
    if (!(high > low)) return;
    // A point on the border of two steps bends both.
    for (const TransferFunction::ColorPoint& point : function.colors) {
        const double place = (point.x - low) / (high - low) * kSteps;
        for (const double side : {place - 1e-6, place + 1e-6})
            bent_[std::size_t(std::clamp(side, 0.0, kSteps - 1.0))] = true;
    }
}

glm::vec3 ValueColors::colorOf(float value) const {
    if (value < first_) return below_;
    const double place = std::clamp((double(value) - first_) * stepsPerUnit_, 0.0, double(kSteps));
    const int step = std::min(int(place), kSteps - 1);
    if (bent_[std::size_t(step)]) return curve_.at((double(value) - low_) / unit_);
    return glm::mix(colors_[step], colors_[step + 1], float(place - step));
}

namespace {

// Far beyond any relevant value; its square still fits into a float.
constexpr double kMost = 1e15;

}  // namespace

double gradientNoise(const Volume& volume) {
    constexpr double kShareOfNoise = 0.01;
    const glm::dvec2 bulk = bulkRange(volume);
    const double most = kShareOfNoise * (bulk.y - bulk.x);
    if (most > 0) return most;
    const double all = kShareOfNoise * (0.5 * volume.valueMax() - 0.5 * volume.valueMin());
    return all > 0 ? all : 1;
}

GradientScale scaledValues(const Volume& volume, double zero, const std::optional<double>& asked) {
    const double noise = asked ? *asked : gradientNoise(volume);
    const auto scaled = [&](double value) {
        return float(std::clamp((value - zero) / noise, -kMost, kMost));
    };
    GradientScale scale;
    scale.unit = noise;
    scale.ofCode.resize(kCodeCount);
    const std::vector<std::uint64_t> counts = uncutHistogram(volume);
    for (std::size_t code = 0; code < counts.size(); ++code) {
        if (counts[code] != 0) scale.ofCode[code] = scaled(volume.codeBook().valueOf(Code(code)));
    }
    if (volume.hasBackground()) scale.background = scaled(volume.background());
    return scale;
}

}  // namespace deltasplat
