// SPDX-License-Identifier: Apache-2.0
#include "picture/rays/ray_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/optics/default_ramp.h"

namespace deltasplat {
namespace {

void requirePositive(const char* option, double number) {
    if (std::isfinite(number) && number > 0) return;
    throw Error(ErrorCode::kUsage, option, numberText(number), "a finite number > 0");
}

// Rays reckon in 32-bit floats: says where these are not enough.
void warnOfFloats(const Volume& volume, const RenderOptions& options, int slices, double stepWorld,
                  const Listener& listener) {
    const ValueMap map = valueMapOf(options);
    const bool sums = showsSums(options.mode);
    const double largest = std::max(std::abs(map(volume.valueMin)), std::abs(map(volume.valueMax)));
    // Below, numbers lose digits: 1e5 times that is what 1e-5 of the largest value needs.
    constexpr double kSmallest = 1e5 * double(std::numeric_limits<float>::min());
    const std::string values = "values of up to " + numberText(largest);
    // Values are added up before they are multiplied by the length of a step.
    const double step = sums ? stepWorld : 1;
    const double sum = largest * slices * std::max(step, 1.0);
    if (largest > kLargestRayValue) {
        listener.warn(values +
                      ": those beyond +-8.5e+37 are taken for that, as x-rays and largest "
                      "values are 32-bit floats");
    } else if (largest > 0 && largest * std::min(step, 1.0) < kSmallest) {
        listener.warn(values + " lose digits, or become 0, as 32-bit floats");
    }
    const bool adds = sums || options.mode == Mode::kAverage;
    if (adds && sum > double(std::numeric_limits<float>::max())) {
        listener.warn(values +
                      " may add up to more than a 32-bit float holds: pixels are wrong where they "
                      "do");
    }
}

// Attenuation is known of Hounsfield units only.
void warnOfOtherUnits(const Volume& volume, const Listener& listener) {
    if (isHounsfield(volume)) return;
    const std::string values =
        "values from " + numberText(volume.valueMin) + " to " + numberText(volume.valueMax);
    listener.warn("`mode` drr: is for Hounsfield units (air -1000, water 0), which " + values +
                  (volume.space.empty()
                       ? " of a file that names no patient's space may not be"
                       : ", with hardly any air or hardly any soft tissue, seem not to be"));
}

// Integrals of Hounsfield units mean little: air counts less than what is outside of the scan.
void warnOfHounsfield(const Volume& volume, const Listener& listener) {
    if (!isHounsfield(volume)) return;
    listener.warn(
        "`mode` xray: adds up Hounsfield units, where air is -1000 and what is outside of the scan "
        "counts as 0, as water does: the less a line of sight has of the scan, the brighter; "
        "`mode` drr makes radiographs");
}

}  // namespace

void checkRayOptions(const RenderOptions& options) {
    requirePositive("`drr.muWater`", options.drr.muWater);
    if (options.drr.photons) requirePositive("`drr.photons`", *options.drr.photons);
    if (!(options.depthShade >= 0 && options.depthShade <= 1)) {
        throw Error(ErrorCode::kUsage, "`depthShade`", numberText(options.depthShade),
                    "a number from 0 to 1");
    }
}

ValueMap valueMapOf(const RenderOptions& options) {
    if (options.mode == Mode::kMin) return {.scale = -1};
    if (options.mode == Mode::kDrr) {
        const double mu = options.drr.muWater;
        return {.scale = mu / 1000, .offset = mu, .least = 0};
    }
    return {};
}

bool showsSums(Mode mode) {
    return mode == Mode::kXray || mode == Mode::kDrr;
}

void warnOfValues(const Volume& volume, const RenderOptions& options, int slices, double stepWorld,
                  const Listener& listener) {
    if (options.mode == Mode::kDrr) warnOfOtherUnits(volume, listener);
    if (options.mode == Mode::kXray) warnOfHounsfield(volume, listener);
    warnOfFloats(volume, options, slices, stepWorld, listener);
}

ValuePainter::ValuePainter(const Volume& volume, const RenderOptions& options,
                           const RayVolume& rays, bool keepsFound)
    : lowest_(rays.lowest),
      highest_(rays.highest),
      darkest_(std::min(rays.lowest, 0.0f)),
      sign_(options.mode == Mode::kMin ? -1.0f : 1.0f),
      keepsFound_(keepsFound) {
    if (options.mipColors) colors_.emplace(volume, options.optics);
}

void ValuePainter::paint(const FoundValue& found, float* rgba) const {
    rgba[3] = found.isMet ? 1.0f : 0.0f;
    if (!found.isMet) {
        std::fill_n(rgba, 3, 0.0f);
        return;
    }
    if (keepsFound_) {
        rgba[0] = found.value;
        rgba[1] = found.shade;
        rgba[2] = found.weight;
        return;
    }
    // No -0.
    const float value = sign_ * std::clamp(found.value, lowest_, highest_) + 0.0f;
    if (colors_) {
        const glm::vec3 color = found.shade * colors_->colorOf(value);
        for (int c = 0; c < 3; ++c) rgba[c] = color[c];
    } else {
        const bool isFull = found.shade == 1;
        std::fill_n(rgba, 3, isFull ? value : darkest_ + found.shade * (value - darkest_));
    }
}

void showTransmission(const Drr& drr, Image& image) {
    const double photons = drr.photons.value_or(1);
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        float* rgba = image.pixel(0, int(y));
        for (int x = 0; x < image.size.x; ++x, rgba += 4) {
            std::fill_n(rgba, 3, float(photons * portable::exp(-double(rgba[0]))));
            rgba[3] = 1;
        }
    });
}

}  // namespace deltasplat
