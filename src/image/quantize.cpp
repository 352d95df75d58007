// SPDX-License-Identifier: Apache-2.0
#include "image/quantize.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "parallel.h"
#include "srgb.h"

namespace deltasplat {
namespace {

// Clamps to 0..1; NaN compares false and becomes 0.
double clampUnit(double value) {
    return value > 0 ? std::min(value, 1.0) : 0.0;
}

template <typename Sample>
Sample quantize(double unit) {
    return Sample(std::lround(unit * std::numeric_limits<Sample>::max()));
}

template <typename Sample>
void straightSrgbPixel(const float* rgba, Sample* result) {
    const double alpha = clampUnit(rgba[3]);
    for (int channel = 0; channel < 3; ++channel) {
        const double straight = alpha > 0 ? clampUnit(rgba[channel] / alpha) : 0;
        result[channel] = quantize<Sample>(srgbFromLinear(straight));
    }
    result[3] = quantize<Sample>(alpha);
}

}  // namespace

std::vector<float> finiteValues(const Image& image, bool forFloat) {
    const float largest = forFloat ? std::numeric_limits<float>::max() : 65504.0f;
    std::vector<float> values = image.rgba;
    for (float& value : values) {
        value = std::isnan(value) ? 0.0f : std::clamp(value, -largest, largest);
    }
    return values;
}

template <typename Sample>
std::vector<Sample> straightSrgb(const Image& image) {
    std::vector<Sample> samples(image.rgba.size());
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        const std::size_t row = y * std::size_t(image.size.x);
        for (std::size_t i = row; i < row + std::size_t(image.size.x); ++i) {
            straightSrgbPixel(&image.rgba[4 * i], &samples[4 * i]);
        }
    });
    return samples;
}

template std::vector<std::uint8_t> straightSrgb(const Image& image);
template std::vector<std::uint16_t> straightSrgb(const Image& image);

}  // namespace deltasplat
