// SPDX-License-Identifier: Apache-2.0
#include "optics/scaled_values.h"

#include <algorithm>

#include "deltasplat/optics/default_ramp.h"
#include "volume/code_counts.h"

namespace deltasplat {
namespace {

// Far more than any value that counts, and its square is a float.
constexpr double kMost = 1e15;

}  // namespace

double gradientNoise(const Volume& volume) {
    constexpr double kShareOfNoise = 0.01;
    const glm::dvec2 bulk = bulkRange(volume);
    const double most = kShareOfNoise * (bulk.y - bulk.x);
    if (most > 0) return most;
    const double all = kShareOfNoise * (0.5 * volume.valueMax - 0.5 * volume.valueMin);
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
        if (counts[code] != 0) scale.ofCode[code] = scaled(volume.codeBook.valueOf(Code(code)));
    }
    if (volume.hasBackground) scale.background = scaled(volume.background);
    return scale;
}

}  // namespace deltasplat
