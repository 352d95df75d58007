// SPDX-License-Identifier: Apache-2.0
#include "image/quantize.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/parallel.h"
#include "image/srgb.h"

namespace deltasplat {
namespace {

// Clamps to 0..1; NaN compares false and becomes 0.
double clampUnit(double value) {
    return value > 0 ? std::min(value, 1.0) : 0.0;
}

// Returns a level in steps of samples, to be truncated.
// @param threshold  in (0, 1): larger fractions are rounded up; 0.5 rounds to nearest
template <typename Sample>
double toSteps(double unit, double threshold) {
    return unit * std::numeric_limits<Sample>::max() + (1 - threshold);
}

template <typename Sample>
Sample quantize(double unit, double threshold) {
    return Sample(int(toSteps<Sample>(unit, threshold)));
}

// The sRGB curve, approximated linearly between 256 points per octave from 2^-9 on.
class SrgbCurve {
  public:
    // Upper bound of its error in 2^-9..1.
    static constexpr double kMostOff = 1e-6;

    SrgbCurve() {
        for (int i = 0; i < kPlaces; ++i)
            values_[std::size_t(i)] =
                srgbFromLinear(std::ldexp(1 + i % kSteps / double(kSteps), i / kSteps - kOctaves));
    }
    static bool knows(double linear) { return linear >= kLeast; }
    double operator()(double linear) const {
        const auto bits = std::bit_cast<std::uint64_t>(linear);
        const auto i = std::size_t((bits >> kFractionBits) - kFirst);
        const auto fraction = double(bits & ((std::uint64_t{1} << kFractionBits) - 1));
        return values_[i] + kStep * fraction * (values_[i + 1] - values_[i]);
    }

  private:
    static constexpr int kOctaves = 9;
    static constexpr double kLeast = 1.0 / (1 << kOctaves);
    static constexpr int kSteps = 256;
    static constexpr int kPlaces = kOctaves * kSteps + 2;  // 1 itself, and one more
    static constexpr int kFractionBits = 52 - 8;
    static constexpr double kStep = 1.0 / double(std::uint64_t{1} << kFractionBits);
    static constexpr std::uint64_t kFirst = std::uint64_t{1023 - kOctaves} << 8;

    std::array<double, kPlaces> values_{};
};

// Quantizes an sRGB level by the table, which saves most powers, unless its error could matter.
template <typename Sample>
Sample quantizeSrgb(const SrgbCurve& curve, double linear, double threshold) {
    if (SrgbCurve::knows(linear)) {
        constexpr double kMostOff = SrgbCurve::kMostOff * std::numeric_limits<Sample>::max();
        const double steps = toSteps<Sample>(curve(linear), threshold);
        const int whole = int(steps);
        if (steps - whole > kMostOff && steps - whole < 1 - kMostOff) return Sample(whole);
    }
    return quantize<Sample>(srgbFromLinear(linear), threshold);
}

const SrgbCurve& srgbCurve() {
    static const SrgbCurve curve;
    return curve;
}

// Spreads thresholds evenly, as multiples of two numbers with fractions hard to approximate (M.
// Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018), in units of 2^-32.
double thresholdAt(std::size_t x, std::size_t y) {
    constexpr std::uint32_t kAlongX = 3242174889;
    constexpr std::uint32_t kAlongY = 2447445414;
    const std::uint32_t place = std::uint32_t(x) * kAlongX + std::uint32_t(y) * kAlongY;
    // Centres of 2^16 steps, so that whole numbers stay unchanged.
    return ((place >> 16) + 0.5) / 65536;
}

template <typename Sample>
void straightSrgbPixel(const SrgbCurve& curve, const float* rgba, double threshold,
                       Sample* result) {
    const double alpha = clampUnit(rgba[3]);
    if (alpha == 0) {
        std::fill_n(result, 4, Sample{0});
        return;
    }
    for (int channel = 0; channel < 3; ++channel) {
        const double straight = clampUnit(rgba[channel] / alpha);
        result[channel] = quantizeSrgb<Sample>(curve, straight, threshold);
    }
    // Inverted: where colour is rounded up, alpha tends to be rounded down.
    result[3] = quantize<Sample>(alpha, 1 - threshold);
}

}  // namespace

// Calls use(pixel index, threshold) for each pixel.
template <typename Use>
void forThresholds(const Image& image, bool dither, const Use& use) {
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        const std::size_t width = std::size_t(image.size.x);
        for (std::size_t x = 0; x < width; ++x)
            use(y * width + x, dither ? thresholdAt(x, y) : 0.5);
    });
}

template <typename Sample>
UnclearedVector<Sample> straightSrgb(const Image& image, bool dither) {
    UnclearedVector<Sample> samples(image.rgba.size());
    const SrgbCurve& curve = srgbCurve();
    forThresholds(image, dither, [&](std::size_t pixel, double threshold) {
        straightSrgbPixel(curve, &image.rgba[4 * pixel], threshold, &samples[4 * pixel]);
    });
    return samples;
}

UnclearedVector<std::uint8_t> opaqueSrgb(const Image& image, bool dither) {
    UnclearedVector<std::uint8_t> samples(image.rgba.size() / 4 * 3);
    const SrgbCurve& curve = srgbCurve();
    forThresholds(image, dither, [&](std::size_t pixel, double threshold) {
        for (std::size_t c = 0; c < 3; ++c) {
            const double linear = clampUnit(image.rgba[4 * pixel + c]);
            samples[3 * pixel + c] = quantizeSrgb<std::uint8_t>(curve, linear, threshold);
        }
    });
    return samples;
}

template UnclearedVector<std::uint8_t> straightSrgb(const Image& image, bool dither);
template UnclearedVector<std::uint16_t> straightSrgb(const Image& image, bool dither);

}  // namespace deltasplat
