// SPDX-License-Identifier: Apache-2.0
// Based on: Stephen Hill's fit of the ACES reference rendering and sRGB output transforms, in M.
// Pettineo and D. Neubelt, "Baking Lab", ACES.hlsl, 2016. Changed: light is scaled first, to keep
// middle grey, and one weight's last digit, so that each matrix row sums to 1.
#include "deltasplat/image/tone.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <glm/vec4.hpp>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/hold_out.h"
#include "image/quantize.h"

namespace deltasplat {

namespace {

// Maps 0.18 to 0.18001.
constexpr double kScale = 1.462;
// Brighter light is white, and squares of this stay finite.
constexpr double kBrightest = 1e6;
// Half a level of 8 bits at white.
constexpr float kSeen = 1.0f / 256;

struct Rgb {
    double r, g, b;
};

// Off-diagonal elements; each row sums to 1 with the diagonal.
struct Mixing {
    double rg, rb, gr, gb, br, bg;
};

// From sRGB's primaries to the film's less saturated ones, and back.
constexpr Mixing kToFilm = {0.35458, 0.04823, 0.07600, 0.01566, 0.02840, 0.13383};
constexpr Mixing kFromFilm = {-0.53108, -0.07367, -0.10208, -0.00605, -0.00327, -0.07276};

// Differences vanish for greys, which therefore stay exactly grey.
Rgb mixed(const Mixing& m, const Rgb& c) {
    return {c.r + m.rg * (c.g - c.r) + m.rb * (c.b - c.r),
            c.g + m.gr * (c.r - c.g) + m.gb * (c.b - c.g),
            c.b + m.br * (c.r - c.b) + m.bg * (c.g - c.b)};
}

double filmCurve(double light) {
    const double v = kScale * light;
    return (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
}

Rgb filmic(const Rgb& light) {
    const Rgb film = mixed(kToFilm, light);
    return mixed(kFromFilm, {filmCurve(film.r), filmCurve(film.g), filmCurve(film.b)});
}

// NaN compares false and becomes 0.
double lightOf(float channel) {
    return channel > 0 ? std::min(double(channel), kBrightest) : 0.0;
}

void tonePixel(float* rgba) {
    const Rgb shown = filmic({lightOf(rgba[0]), lightOf(rgba[1]), lightOf(rgba[2])});
    rgba[0] = float(std::clamp(shown.r, 0.0, 1.0));
    rgba[1] = float(std::clamp(shown.g, 0.0, 1.0));
    rgba[2] = float(std::clamp(shown.b, 0.0, 1.0));
    rgba[3] = std::max({rgba[3], rgba[0], rgba[1], rgba[2]});
}

// Exact where `exponent` is whole.
double powerOfTwo(double exponent) {
    const double whole = std::floor(exponent);
    return std::ldexp(portable::exp((exponent - whole) * std::numbers::ln2), int(whole));
}

template <typename Use>
void forPixels(Image& image, const Use& use) {
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        for (int x = 0; x < image.size.x; ++x) use(image.pixel(x, int(y)));
    });
}

bool isClear(const float* rgba) {
    return !(rgba[0] > 0 || rgba[1] > 0 || rgba[2] > 0 || rgba[3] > 0);
}

bool isClipped(const float* rgba) {
    const float most = std::max(rgba[3], 0.0f) + kSeen;
    return rgba[0] > most || rgba[1] > most || rgba[2] > most;
}

}  // namespace

std::string toneName(Tone tone) {
    return tone == Tone::kFilmic ? "filmic" : "standard";
}

void expose(Image& image, double exposureStops) {
    const DefaultFloats floats;
    if (!(std::abs(exposureStops) <= kMaxExposureStops)) {
        const std::string most = numberText(kMaxExposureStops);
        throw Error(ErrorCode::kUsage, "`exposureStops`", numberText(exposureStops),
                    "a finite number from -" + most + " to " + most);
    }
    constexpr double kMost = std::numeric_limits<float>::max();
    const double scale = powerOfTwo(exposureStops);
    forPixels(image, [&](float* rgba) {
        for (int channel = 0; channel < 3; ++channel)
            rgba[channel] = float(std::clamp(scale * rgba[channel], -kMost, kMost));
    });
}

void toneFilmic(Image& image) {
    const DefaultFloats floats;
    forPixels(image, tonePixel);
}

double clippedShare(const Image& image) {
    const DefaultFloats floats;
    std::atomic<std::size_t> seen = 0, clipped = 0;
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        std::size_t seenHere = 0, clippedHere = 0;
        for (int x = 0; x < image.size.x; ++x) {
            const float* const rgba = image.pixel(x, int(y));
            seenHere += !isClear(rgba);
            clippedHere += isClipped(rgba);
        }
        seen += seenHere;
        clipped += clippedHere;
    });
    return seen > 0 ? double(clipped) / double(seen) : 0.0;
}

std::size_t countBeyondHalf(const Image& image) {
    std::atomic<std::size_t> beyond = 0;
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        std::size_t beyondHere = 0;
        for (int x = 0; x < image.size.x; ++x) {
            const float* const rgba = image.pixel(x, int(y));
            beyondHere +=
                std::any_of(rgba, rgba + 4, [](float v) { return std::abs(v) > kLargestHalf; });
        }
        beyond += beyondHere;
    });
    return beyond;
}

// Based on: P. Hillman, The Theory of OpenEXR Deep Samples, 2013 (splitting a volume sample).
namespace {

// Returns the part of a sample in front of a depth.
glm::vec4 cutAt(const DeepSample& sample, float depth) {
    if (depth >= sample.zBack) return sample.rgba;
    if (depth <= sample.z) return glm::vec4(0);
    const double share = (double(depth) - sample.z) / (double(sample.zBack) - sample.z);
    const double alpha = sample.rgba.a;
    if (alpha >= 1) return sample.rgba;
    if (alpha <= 0) return sample.rgba * float(share);
    const double left = -portable::expm1(share * portable::log1p(-alpha));
    return sample.rgba * float(left / alpha);
}

}  // namespace

Image holdOut(const DeepImage& deep, const DepthImage& solid) {
    const DefaultFloats floats;
    if (deep.size != solid.size) {
        throw Error(ErrorCode::kUsage, "depths of solid things", dimsText(solid.size) + " pixels",
                    dimsText(deep.size) + ", those of the picture");
    }
    Image image(deep.size);
    parallelFor(std::size_t(deep.size.y), [&](std::size_t y) {
        for (int x = 0; x < deep.size.x; ++x) {
            float* rgba = image.pixel(x, int(y));
            const float depth = solid.depths[y * std::size_t(deep.size.x) + std::size_t(x)];
            for (const DeepSample& sample : deep.pixel(x, int(y))) {
                if (sample.z >= depth) break;
                const glm::vec4 seen = cutAt(sample, depth);
                const float clear = 1 - rgba[3];
                for (int c = 0; c < 4; ++c) rgba[c] += clear * seen[c];
            }
        }
    });
    return image;
}

}  // namespace deltasplat
