// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>

#include "deltasplat/synth/analytic_volume.h"
#include "deltasplat/synth/write_analytic.h"

namespace deltasplat {

/// Returns 0 up to `low`, 1 from `high` on, and a curve with level ends in between.
inline double smoothStep(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Returns the larger number, raised by at most `width` / 4 where they differ by less than `width`:
/// the zero surfaces merge without a crease.
inline double smoothMax(double a, double b, double width) {
    const double near = std::max(width - std::abs(a - b), 0.0) / width;
    return std::max(a, b) + near * near * width / 4;
}

/// A volume's value 0..1 at a position in [-1, 1]^3.
using ValueAt = std::function<double(const glm::dvec3& position)>;

// One function per name in analyticNames().
ValueAt makeMarschnerLobb();
ValueAt makeHydrogen();
ValueAt makeSheppLogan();
ValueAt makeEngine(std::uint64_t seed, double noise);
ValueAt makeCloud(std::uint64_t seed);
ValueAt makeSlab();
ValueAt makeVessels(std::uint64_t seed, double noise);
ValueAt makeBody();
AnalyticVolume makeFire(std::uint64_t seed);
AnalyticVolume makeExplosion(std::uint64_t seed);

/// Returns the mean of a voxel's sample points.
/// @param valueAt  maps a position to a number or a vector
template <typename ValueAt>
auto sampleVoxel(const ValueAt& valueAt, const glm::ivec3& index,
                 const AnalyticFileOptions& options) {
    const int each = options.samples;
    decltype(valueAt(glm::dvec3())) sum(0);
    for (int n = 0; n < each * each * each; ++n) {
        const glm::dvec3 part(n % each, n / each % each, n / (each * each));
        const glm::dvec3 at = 2.0 * glm::dvec3(index) + (2.0 * part + 1.0) / double(each);
        sum += valueAt(at / glm::dvec3(options.dims) - 1.0);
    }
    return sum / double(each * each * each);
}

}  // namespace deltasplat
