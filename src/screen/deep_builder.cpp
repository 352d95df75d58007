// SPDX-License-Identifier: Apache-2.0
// Based on: Tom Lokovic and Eric Veach, "Deep Shadow Maps", SIGGRAPH 2000, section 3: filter the
// visibility down to a depth, not the layers. Layers resampled one by one would hide light: if two
// of them end at one edge of a pixel, one hides half of what passes the other. Deviates in treating
// colour likewise, and in using slices' depths for all pixels.
#include "screen/deep_builder.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <optional>
#include <string>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "deltasplat/image/image.h"

namespace deltasplat {

namespace {

// From this distance on, separate runs take less memory.
constexpr int kFarApart = 4;
// Below this visibility half floats hardly resolve alpha, and filters overshoot by more.
constexpr double kLeastSeen = 0x1p-10;

glm::vec4 colorAt(const Image& image, int x, int y) {
    const float* rgba = image.pixel(x, y);
    return {rgba[0], rgba[1], rgba[2], rgba[3]};
}

}  // namespace

DeepBuilder::DeepBuilder(glm::ivec2 size, int slicesPerSample)
    : shown_(size), slicesPerSample_(slicesPerSample), rows_(std::size_t(size.y)) {}

void DeepBuilder::require(double bytes) const {
    requireMemory(
        "samples of a deep picture, `slicesPerSample` " + std::to_string(slicesPerSample_), bytes);
}

void DeepBuilder::add(const Image& picture, double front, double back) {
    std::atomic<std::size_t> changed = 0;
    parallelFor(rows_.size(), [&](std::size_t y) { changed += findChanges(picture, int(y)); });
    if (changed == 0) return;
    require(double(changed) * sizeof(glm::vec4));
    kept_ += changed;
    stages_.push_back({depths_, front, back});
    parallelFor(rows_.size(), [&](std::size_t y) { keepChanges(picture, int(y)); });
}

// Returns how many pixels of a row must be kept.
std::size_t DeepBuilder::findChanges(const Image& picture, int y) {
    std::vector<Columns>& changed = rows_[std::size_t(y)].changed;
    changed.clear();
    std::size_t count = 0;
    for (int x = 0; x < picture.size.x; ++x) {
        if (colorAt(picture, x, y) == colorAt(shown_, x, y)) continue;
        if (changed.empty() || x - changed.back().last >= kFarApart) changed.push_back({x, x});
        count += std::size_t(x + 1 - changed.back().last);
        changed.back().last = x + 1;
    }
    return count;
}

void DeepBuilder::keepChanges(const Image& picture, int y) {
    Row& row = rows_[std::size_t(y)];
    for (const Columns& columns : row.changed) {
        Run run{stages_.size() - 1, columns.first, {}};
        run.colors.reserve(std::size_t(columns.last - columns.first));
        for (int x = columns.first; x < columns.last; ++x)
            run.colors.push_back(colorAt(picture, x, y));
        std::copy_n(picture.pixel(columns.first, y), 4 * run.colors.size(),
                    shown_.pixel(columns.first, y));
        row.runs.push_back(std::move(run));
    }
}

DeepImage DeepBuilder::finish() {
    // Runs of finished rows have been freed.
    require(double(kept_) * (sizeof(DeepSample) - sizeof(glm::vec4)) +
            double(shown_.rgba.size()) / 4 * sizeof(std::size_t));
    DeepImage image{shown_.size, std::vector<DeepRow>(rows_.size())};
    parallelFor(rows_.size(), [&](std::size_t y) { image.rows[y] = makeRow(int(y)); });
    return image;
}

DeepRow DeepBuilder::makeRow(int y) {
    const std::vector<Run> runs = std::exchange(rows_[std::size_t(y)].runs, {});
    const auto width = std::size_t(shown_.size.x);
    // Sort states by pixels, keeping the order of stages.
    std::vector<std::size_t> begins(width + 1);
    for (const Run& run : runs)
        for (std::size_t i = 0; i < run.colors.size(); ++i)
            ++begins[std::size_t(run.first) + i + 1];
    for (std::size_t x = 0; x < width; ++x) begins[x + 1] += begins[x];
    std::vector<State> states(begins.back());
    std::vector<std::size_t> next(begins.begin(), begins.end() - 1);
    for (const Run& run : runs)
        for (std::size_t i = 0; i < run.colors.size(); ++i)
            states[next[std::size_t(run.first) + i]++] = {run.stage, run.colors[i]};
    DeepRow row;
    row.begins.reserve(width + 1);
    row.samples.reserve(states.size());
    std::vector<State> ofPixel;
    for (std::size_t x = 0; x < width; ++x) {
        ofPixel.assign(states.begin() + std::ptrdiff_t(begins[x]),
                       states.begin() + std::ptrdiff_t(begins[x + 1]));
        addSamples({int(x), y}, ofPixel, row);
        row.begins.push_back(row.samples.size());
    }
    row.samples.shrink_to_fit();
    return row;
}

void DeepBuilder::addSamples(glm::ivec2 pixel, std::vector<State>& states, DeepRow& row) const {
    if (states.empty()) return;
    // Filters overshoot, so a pixel may become darker by what is put behind. Samples cannot take
    // light away: the surplus is removed from the samples in front.
    for (std::size_t i = states.size() - 1; i > 0; --i)
        states[i - 1].color = glm::min(states[i - 1].color, states[i].color);
    // All samples belong to one region; unchanged states may belong to others.
    std::optional<DepthLine> line;
    glm::dvec4 before(0);
    for (const State& state : states) {
        // The last sample that lets hardly anything through shows all the light that does.
        const bool isLast = 1 - double(state.color.a) < kLeastSeen;
        const glm::dvec4 color(isLast ? states.back().color : state.color);
        if (color == before) continue;
        const Stage& stage = stages_[state.stage];
        if (!line) line = stage.depths->lineAt(pixel.x, pixel.y);
        row.samples.push_back(sampleOf(*line, stage, (color - before) / (1 - before.a)));
        if (isLast) break;
        before = color;
    }
}

DeepSample DeepBuilder::sampleOf(const DepthLine& line, const Stage& stage,
                                 const glm::dvec4& color) const {
    const double nearest = stage.depths->nearest();
    const auto depthAt = [&](double slice) { return float(std::max(line.at(slice), nearest)); };
    DeepSample sample{glm::vec4(color), depthAt(stage.front), depthAt(stage.back)};
    // Rounding must not swap the ends.
    sample.zBack = std::max(sample.z, sample.zBack);
    return sample;
}

// A parallel camera may stand anywhere, so its depths may be negative.
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

// Filters overshoot and may take alpha away. Such alpha was never there; means lose it evenly.
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
        // Opaque matter is met where it begins.
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
