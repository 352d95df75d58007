// SPDX-License-Identifier: Apache-2.0
// Based on: G. Box, M. Muller, "A Note on the Generation of Random Normal Deviates", 1958.
#include "synth/noise.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "portable_math.h"
#include "synth/hash.h"

namespace deltasplat {
namespace {

// A normally distributed number that depends on nothing but the seed and the position.
double gaussianAt(std::uint64_t seed, const glm::dvec3& p) {
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // -0 is 0
    const std::uint64_t hash = hash3(seed, bits(p.x), bits(p.y), bits(p.z));
    const double radius = std::sqrt(-2 * portable::log(1 - unitFromBits(hash)));
    return radius * portable::cos(2 * std::numbers::pi * unitFromBits(mixBits(hash + 1)));
}

}  // namespace

ValueAt withNoise(ValueAt valueAt, std::uint64_t seed, double noise) {
    if (noise == 0) return valueAt;
    return [valueAt = std::move(valueAt), seed, noise](const glm::dvec3& p) {
        return std::clamp(valueAt(p) + noise * gaussianAt(seed, p), 0.0, 1.0);
    };
}

}  // namespace deltasplat
