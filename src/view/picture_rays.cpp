// SPDX-License-Identifier: Apache-2.0
#include "view/picture_rays.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "base/affine.h"
#include "base/portable_math.h"

namespace deltasplat {

PictureRays::PictureRays(const Camera& camera, const glm::dmat3& fromWorld) {
    const glm::dvec3 right = fromWorld * camera.right;
    const glm::dvec3 up = fromWorld * camera.up;
    const glm::dvec3 ahead = fromWorld * camera.direction;
    const glm::dvec2 size(camera.sizePixels);
    const bool flat = camera.projection == Projection::kPerspective;
    const glm::dvec2 middle = camera.targetPixel();
    // For a flat picture at distance 1.
    const double pixel = camera.pixelWorld() / camera.targetDistanceWorld;
    const double pixelHeight = camera.pixelHeightWorld() / camera.targetDistanceWorld;
    // For a panorama: the angle of a pixel.
    const glm::dvec2 angle = glm::dvec2(2, 1) * std::numbers::pi / size;
    for (int x = 0; x < camera.sizePixels.x; ++x) {
        const double across = x + 0.5 - middle.x;
        if (flat) {
            columns_.push_back({ahead + (across * pixel) * right, pixel * right});
            continue;
        }
        const double sine = portable::sin(angle.x * across);
        const double cosine = portable::cos(angle.x * across);
        columns_.push_back(
            {sine * right + cosine * ahead, angle.x * (cosine * right - sine * ahead)});
    }
    for (int y = 0; y < camera.sizePixels.y; ++y) {
        const double above = middle.y - (y + 0.5);
        if (flat) {
            rows_.push_back({1, 0, (above * pixelHeight) * up, -pixelHeight * up});
            continue;
        }
        const double sine = portable::sin(angle.y * above);
        const double cosine = portable::cos(angle.y * above);
        rows_.push_back({cosine, angle.y * sine, sine * up, -angle.y * cosine * up});
    }
}

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double arcSine(double x) {
    return portable::atan2(x, std::sqrt(1 - x * x));
}

PixelBox pixelsOf(const glm::dvec2& low, const glm::dvec2& high, const glm::ivec2& size) {
    // Reach of filters.
    constexpr double kAround = 4;
    const glm::dvec2 most(size);
    return {glm::ivec2(glm::clamp(glm::floor(low - kAround), glm::dvec2(0), most)),
            glm::ivec2(glm::clamp(glm::ceil(high + kAround), glm::dvec2(0), most))};
}

}  // namespace

SeenBox seenBox(const IndexBox& box, const glm::dmat4& world, const Camera& camera, double reach) {
    const auto cornersAround = [&](double around) {
        std::vector<glm::dvec3> corners;
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 beyond(i & 1 ? around : -around, i & 2 ? around : -around,
                                    i & 4 ? around : -around);
            corners.emplace_back(world * glm::dvec4(cornerOf(box, i) + beyond, 1));
        }
        return corners;
    };
    const glm::ivec2 size = camera.sizePixels;
    const SeenBox all{{{0, 0}, size}, glm::dvec2(kInfinite)};
    const std::vector<glm::dvec3> around = cornersAround(reach);
    if (camera.projection == Projection::kLatlong) {
        const glm::dvec3 middle = 0.5 * (around.front() + around.back());
        double radius = 0;
        for (const glm::dvec3& corner : around)
            radius = std::max(radius, glm::distance(middle, corner));
        const double distance = glm::distance(middle, camera.eyeWorld());
        // Closer than this, the box is nearly all around.
        constexpr double kNear = 1.5;
        if (!(distance > kNear * radius)) return all;
        const double pixelsPerRadian = size.x / (2 * std::numbers::pi);
        const double angle = arcSine(radius / distance);
        const glm::dvec2 at = camera.pixelFromWorld(middle);
        const double rows = angle * pixelsPerRadian;
        const double latitude = std::abs(0.5 * size.y - at.y) / pixelsPerRadian;
        SeenBox seen{all.part, glm::dvec2(2 * rows)};
        glm::dvec2 low(0, at.y - rows);
        glm::dvec2 high(size.x, at.y + rows);
        if (latitude + angle < 0.49 * std::numbers::pi) {
            const double columns =
                pixelsPerRadian *
                arcSine(std::min(1.0, portable::sin(angle) / portable::cos(latitude)));
            // Boxes across the seam of left and right are visible at both.
            constexpr double kSeam = 4;
            if (at.x - columns > kSeam && at.x + columns < size.x - kSeam) {
                low.x = at.x - columns;
                high.x = at.x + columns;
            }
            seen.size.x = 2 * columns;
        }
        seen.part = pixelsOf(low, high, size);
        return seen;
    }
    const auto depthOf = [&](const glm::dvec3& corner) {
        return glm::dot(corner - camera.eyeWorld(), camera.direction);
    };
    if (camera.projection == Projection::kPerspective) {
        const auto isBehind = [&](const glm::dvec3& corner) { return !(depthOf(corner) > 0); };
        if (std::all_of(around.begin(), around.end(), isBehind)) return {};
        if (std::any_of(around.begin(), around.end(), isBehind)) return all;
    }
    const auto boxOfAll = [&](const std::vector<glm::dvec3>& corners) {
        glm::dvec2 low(kInfinite);
        glm::dvec2 high(-kInfinite);
        for (const glm::dvec3& corner : corners) {
            const glm::dvec2 pixel = camera.pixelFromWorld(corner);
            low = glm::min(low, pixel);
            high = glm::max(high, pixel);
        }
        return std::pair(low, high);
    };
    const auto [low, high] = boxOfAll(around);
    const auto [first, last] = boxOfAll(cornersAround(0.5));
    return {pixelsOf(low, high, size), last - first};
}

}  // namespace deltasplat
