// SPDX-License-Identifier: Apache-2.0
#include "render/value_window.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "base/portable_math.h"
#include "image/srgb.h"

namespace deltasplat {
namespace {

// A line of sight in voxels; what lies before `nearest` lengths of `along` is not seen.
struct Sight {
    glm::dvec3 from;
    glm::dvec3 along;
    double nearest;
};

// Whether a line of sight meets a box, by the slabs between its faces.
bool meets(const Sight& sight, const glm::dvec3& low, const glm::dvec3& high) {
    const auto& [from, along, nearest] = sight;
    double first = nearest;
    double last = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (along[axis] == 0) {
            if (from[axis] < low[axis] || from[axis] > high[axis]) return false;
            continue;
        }
        const double a = (low[axis] - from[axis]) / along[axis];
        const double b = (high[axis] - from[axis]) / along[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last;
}

Sight sightOf(const Camera& camera, const glm::dmat4& indexFromWorld, glm::dvec2 pixel) {
    const glm::dvec3 ray = camera.rayThrough(pixel);
    const glm::dvec3 along = indexFromWorld * glm::dvec4(ray, 0);
    if (camera.projection == Projection::kOrtho) {
        return {indexFromWorld * glm::dvec4(camera.worldFromPixel(pixel), 1), along,
                -std::numeric_limits<double>::infinity()};
    }
    const bool flat = camera.projection == Projection::kPerspective;
    const double depth = flat ? glm::dot(ray, camera.direction) : glm::length(ray);
    return {indexFromWorld * glm::dvec4(camera.eyeWorld(), 1), along, camera.nearWorld / depth};
}

// Sets alpha to 1 where the line of sight meets the volume's box, voxels whole, else to 0.
void coverBox(const Volume& volume, const Camera& camera, Image& image) {
    const glm::dmat4 indexFromWorld = glm::inverse(volume.worldFromIndex());
    const glm::dvec3 low = glm::dvec3(volume.box().min) - 0.5;
    const glm::dvec3 high = glm::dvec3(volume.box().max) + 0.5;
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        for (int x = 0; x < image.size.x; ++x) {
            const Sight sight = sightOf(camera, indexFromWorld, {x + 0.5, double(y) + 0.5});
            image.pixel(x, int(y))[3] = meets(sight, low, high) ? 1.0f : 0.0f;
        }
    });
}

// -ln of the share of photons that gets through.
void attenuate(const Drr& drr, Image& image) {
    const double photons = drr.photons.value_or(1);
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        float* rgba = image.pixel(0, int(y));
        for (int x = 0; x < image.size.x; ++x, rgba += 4) {
            // What is nothing in 32 bits attenuates as much as the least that is something.
            const double share =
                std::max(rgba[0] / photons, double(std::numeric_limits<float>::denorm_min()));
            std::fill_n(rgba, 3, float(-portable::log(share) + 0.0));
        }
    });
}

}  // namespace

bool addsUp(Mode mode) {
    return mode == Mode::kXray || mode == Mode::kDrr;
}

void readyForGreys(const RenderOptions& options, const Volume& volume, const Camera& camera,
                   Image& image) {
    if (options.mode == Mode::kXray && !volume.empty()) coverBox(volume, camera, image);
    if (options.mode == Mode::kDrr) attenuate(options.drr, image);
}

std::optional<glm::dvec2> middleValues(Mode mode, const Image& image) {
    std::vector<float> values;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const bool isOne = image.rgba[i + 3] > 0 && !(addsUp(mode) && image.rgba[i] == 0);
        if (isOne) values.push_back(image.rgba[i]);
    }
    if (values.empty()) return {};
    const std::size_t rank = (values.size() - 1) / 200;  // from either end
    const auto at = [&](std::size_t i) {
        std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(i), values.end());
        return double(values[i]);
    };
    return glm::dvec2(at(rank), at(values.size() - 1 - rank));
}

glm::dvec2 defaultWindow(Mode mode, const std::optional<glm::dvec2>& middle) {
    glm::dvec2 window = middle.value_or(glm::dvec2(0, 1));
    if (addsUp(mode)) window.x = std::min(window.x, 0.0);
    if (window.x < window.y) return window;
    // One value only is white if it is above 0, for black is nothing; otherwise it is black, and
    // nothing is white.
    if (window.y > 0) return {0, window.y};
    return {window.y, window.y < 0 ? 0 : 1};
}

void showGreys(glm::dvec2 window, Image& image) {
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        float* rgba = image.pixel(0, int(y));
        for (int x = 0; x < image.size.x; ++x, rgba += 4) {
            const double level = (rgba[0] - window.x) / (window.y - window.x);
            const double grey = rgba[3] > 0 ? linearFromSrgb(std::clamp(level, 0.0, 1.0)) : 0;
            for (int c = 0; c < 3; ++c) rgba[c] = float(grey);
        }
    });
}

}  // namespace deltasplat
