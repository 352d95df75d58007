// SPDX-License-Identifier: Apache-2.0
#include "image/stored_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/quantize.h"

namespace deltasplat {
namespace {

constexpr float kBelowOne = 1 - 0x1p-11f;  // the next half

glm::vec4 finite(const glm::vec4& color, float largest) {
    glm::vec4 result;
    for (int c = 0; c < 4; ++c) result[c] = finiteValue(color[c], largest);
    return result;
}

// Rounds to 11 significant bits, or to 2^-24.
float roundedToHalf(double value) {
    if (value == 0) return 0;
    const double step = std::ldexp(1.0, std::max(std::ilogb(value), -14) - 10);
    return float(std::clamp(std::nearbyint(value / step) * step, -double(kLargestHalf),
                            double(kLargestHalf)));
}

// Of one sign with what is meant, or nothing; what is nothing stays so.
double ofSameSign(double value, float meant) {
    return meant > 0 ? std::max(value, 0.0) : meant < 0 ? std::min(value, 0.0) : 0.0;
}

class HalfRounder {
  public:
    glm::vec4 rounded(const glm::vec4& color, bool isLast) {
        whole_ += (1 - whole_.a) * glm::dvec4(color);
        const double left = 1 - shown_.a;
        glm::dvec4 wanted(color);
        if (left > 0) wanted = (whole_ - shown_) / left;
        glm::vec4 result;
        for (int c = 0; c < 4; ++c) result[c] = roundedToHalf(ofSameSign(wanted[c], color[c]));
        if (color.a < 1 && !isLast) result.a = std::min(result.a, kBelowOne);
        shown_ += left * glm::dvec4(result);
        return result;
    }

  private:
    glm::dvec4 whole_{0.0};
    glm::dvec4 shown_{0.0};
};

}  // namespace

void addStored(std::span<const DeepSample> samples, bool asFloat, std::vector<DeepSample>& stored) {
    const float largest = asFloat ? std::numeric_limits<float>::max() : kLargestHalf;
    HalfRounder halves;
    for (const DeepSample& sample : samples) {
        glm::vec4 color = finite(sample.rgba, largest);
        if (!asFloat) color = halves.rounded(color, &sample == &samples.back());
        if (color != glm::vec4(0)) stored.push_back({color, sample.z, sample.zBack});
    }
}

}  // namespace deltasplat
