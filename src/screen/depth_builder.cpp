// SPDX-License-Identifier: Apache-2.0
#include "screen/depth_builder.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "deltasplat/image/image.h"

namespace deltasplat {
// Depths of a parallel picture begin at its camera, which may be anywhere.
DepthBuilder::DepthBuilder(const Camera& camera, double opacity, Growth growth)
    : size_(camera.sizePixels),
      nearest_(camera.projection == Projection::kOrtho ? -std::numeric_limits<double>::infinity()
                                                       : camera.nearWorld),
      opacity_(opacity),
      growth_(growth) {
    const double pixels = double(size_.x) * size_.y;
    requireMemory("`aovs` of depth", sizeof(Pixel) * pixels);
    pixels_.resize(std::size_t(pixels));
}

void DepthBuilder::begin(std::shared_ptr<const SliceDepths> depths) {
    regions_.push_back(std::move(depths));
}

void DepthBuilder::add(const Image& picture, double front, double back) {
    const Stage stage{front, back};
    parallelFor(std::size_t(size_.y), [&](std::size_t y) {
        for (int x = 0; x < size_.x; ++x) {
            const float alpha = picture.pixel(x, int(y))[3];
            Pixel& pixel = pixels_[y * std::size_t(size_.x) + std::size_t(x)];
            if (alpha != pixel.alpha) change(pixel, alpha, stage);
        }
    });
}

// Filters overshoot, so that what is put behind may take alpha away. What is gone again was not
// there; a mean loses it of all alike.
void DepthBuilder::change(Pixel& pixel, float alpha, const Stage& stage) const {
    pixel.region = std::uint32_t(regions_.size() - 1);
    const double before = std::min(pixel.alpha, alpha);
    if (alpha < opacity_) {
        pixel.front = kNowhere;
    } else if (before < opacity_) {
        pixel.front = passedAt(before, alpha, stage);
    }
    if (alpha - pixel.alphaAtBack > kLeastGrowth) {
        pixel.back = stage.back;
        pixel.alphaAtBack = alpha;
    } else {
        pixel.alphaAtBack = std::min(pixel.alphaAtBack, alpha);
    }
    if (alpha > pixel.alpha && 1 - double(pixel.alpha) >= kLeastGrowth) ++pixel.samples;
    if (alpha < pixel.alpha) {
        pixel.sum *= double(alpha) / pixel.alpha;
    } else {
        pixel.sum += (double(alpha) - pixel.alpha) * 0.5 * (stage.front + stage.back);
    }
    pixel.alpha = alpha;
}

double DepthBuilder::passedAt(double before, double after, const Stage& stage) const {
    double share = (opacity_ - before) / (after - before);
    if (growth_ == Growth::kFog) {
        // What is opaque is met where it begins.
        share = after < 1 ? portable::log((1 - opacity_) / (1 - before)) /
                                portable::log((1 - after) / (1 - before))
                          : 0;
    }
    return stage.front + std::clamp(share, 0.0, 1.0) * (stage.back - stage.front);
}

template <typename PositionOf>
std::vector<float> DepthBuilder::depths(const PositionOf& positionOf) const {
    std::vector<float> depths(pixels_.size(), kNoDepth);
    parallelFor(std::size_t(size_.y), [&](std::size_t y) {
        for (int x = 0; x < size_.x; ++x) {
            const std::size_t i = y * std::size_t(size_.x) + std::size_t(x);
            const double position = positionOf(pixels_[i]);
            if (!(position == position)) continue;
            const DepthLine line = regions_[pixels_[i].region]->lineAt(x, int(y));
            depths[i] = float(std::max(line.at(position), nearest_));
        }
    });
    return depths;
}

std::vector<float> DepthBuilder::front() const {
    return depths([](const Pixel& pixel) { return pixel.front; });
}

std::vector<float> DepthBuilder::back() const {
    return depths([](const Pixel& pixel) { return pixel.back; });
}

std::vector<float> DepthBuilder::mean() const {
    return depths(
        [](const Pixel& pixel) { return pixel.alpha > 0 ? pixel.sum / pixel.alpha : kNowhere; });
}

std::vector<float> DepthBuilder::samples() const {
    std::vector<float> samples;
    samples.reserve(pixels_.size());
    for (const Pixel& pixel : pixels_) samples.push_back(float(pixel.samples));
    return samples;
}

}  // namespace deltasplat
