// SPDX-License-Identifier: Apache-2.0
// Based on: Paul Debevec, "A Median Cut Algorithm for Light Probe Sampling", 2005 (regions of a
// lat-long picture, each cut in two, by sums over rectangles), and Kuntee Viriyothai and Paul
// Debevec, "Variance Minimization Light Probe Sampling", 2009 (which cut to make next). Unlike
// there, distances are between directions in space, so poles and row ends need no special case.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>
#include <queue>
#include <string>

#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/optics/environment.h"
#include "image/srgb.h"
#include "view/picture_rays.h"

namespace deltasplat {
namespace {

struct Moments {
    double energy = 0;  // luminance times solid angle
    glm::dvec3 way{0};  // sum of energy times direction

    Moments& operator+=(const Moments& other) {
        energy += other.energy;
        way += other.way;
        return *this;
    }
    Moments& operator-=(const Moments& other) {
        energy -= other.energy;
        way -= other.way;
        return *this;
    }
    // The sum of energy times squared distance from the mean direction.
    double spread() const {
        if (!(energy > 0)) return 0;
        return std::max(0.0, energy - glm::dot(way, way) / energy);
    }
};

Moments operator+(Moments a, const Moments& b) {
    return a += b;
}
Moments operator-(Moments a, const Moments& b) {
    return a -= b;
}

// Pixels, or squares of pixels: sums over more would take a GiB, and finer cuts gain nothing.
constexpr int kMostCellsAcross = 1024;

struct Cell {
    glm::dvec3 color{0};  // radiance times solid angle
    Moments moments;
};

class Cells {
  public:
    explicit Cells(const Environment& environment)
        : side_((environment.sizePixels.x + kMostCellsAcross - 1) / kMostCellsAcross),
          size_((environment.sizePixels + side_ - 1) / side_),
          cells_(std::size_t(size_.x) * std::size_t(size_.y)) {
        Camera all;
        all.projection = Projection::kLatlong;
        all.sizePixels = environment.sizePixels;
        const PictureRays rays(all, glm::dmat3(1));
        parallelFor(std::size_t(size_.y), [&](std::size_t row) {
            const int last = std::min(environment.sizePixels.y, (int(row) + 1) * side_);
            for (int y = int(row) * side_; y < last; ++y) addRow(environment, rays, y);
        });
    }
    glm::ivec2 size() const { return size_; }
    const Cell& at(int x, int y) const {
        return cells_[std::size_t(y) * std::size_t(size_.x) + std::size_t(x)];
    }

  private:
    void addRow(const Environment& environment, const PictureRays& rays, int y) {
        const glm::ivec2 size = environment.sizePixels;
        // Between two latitudes: sin a - sin b = 2 cos((a + b) / 2) sin((a - b) / 2).
        const double step = std::numbers::pi / size.y;
        const double height =
            2 * portable::cos(step * (0.5 * size.y - (y + 0.5))) * portable::sin(0.5 * step);
        const double solidAngle = 2 * std::numbers::pi / size.x * height;
        const float* rgb = &environment.rgb[3 * std::size_t(y) * std::size_t(size.x)];
        Cell* row = &cells_[std::size_t(y / side_) * std::size_t(size_.x)];
        for (int x = 0; x < size.x; ++x, rgb += 3) {
            const glm::dvec3 color = solidAngle * glm::dvec3(rgb[0], rgb[1], rgb[2]);
            const double energy = glm::dot(color, kLuminance);
            Cell& cell = row[x / side_];
            cell.color += color;
            cell.moments += {energy, energy * rays.at(x, y)};
        }
    }

    int side_;  // in pixels
    glm::ivec2 size_;
    std::vector<Cell> cells_;
};

struct Region {
    glm::ivec2 first{0};
    glm::ivec2 end{0};
    double spread = 0;

    // The largest spread is cut next; of equal ones, the first.
    bool operator<(const Region& other) const {
        if (spread != other.spread) return spread < other.spread;
        return first.y != other.first.y ? first.y > other.first.y : first.x > other.first.x;
    }
};

// Sums over any rectangle of cells.
class SummedCells {
  public:
    explicit SummedCells(const Cells& cells)
        : width_(std::size_t(cells.size().x) + 1),
          sums_(width_ * (std::size_t(cells.size().y) + 1)) {
        for (int y = 0; y < cells.size().y; ++y) {
            Moments row;
            for (int x = 0; x < cells.size().x; ++x) {
                row += cells.at(x, y).moments;
                sums_[index(x + 1, y + 1)] = sums_[index(x + 1, y)] + row;
            }
        }
    }
    Region region(glm::ivec2 first, glm::ivec2 end) const {
        return {first, end, sum(first, end).spread()};
    }

    // Cuts a region of more than one cell where the parts' spreads have the least sum.
    std::pair<Region, Region> cut(const Region& region) const {
        std::pair<Region, Region> best;
        double least = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 2; ++axis) {
            for (int at = region.first[axis] + 1; at < region.end[axis]; ++at) {
                glm::ivec2 end = region.end, first = region.first;
                end[axis] = first[axis] = at;
                const Region before = this->region(region.first, end);
                const Region behind = this->region(first, region.end);
                if (!(before.spread + behind.spread < least)) continue;
                least = before.spread + behind.spread;
                best = {before, behind};
            }
        }
        return best;
    }

  private:
    std::size_t index(int x, int y) const { return std::size_t(y) * width_ + std::size_t(x); }
    Moments sum(glm::ivec2 first, glm::ivec2 end) const {
        return (sums_[index(end.x, end.y)] - sums_[index(first.x, end.y)]) -
               (sums_[index(end.x, first.y)] - sums_[index(first.x, first.y)]);
    }

    std::size_t width_;
    std::vector<Moments> sums_;
};

std::vector<Region> cutIntoRegions(const Cells& cells, int count) {
    const SummedCells sums(cells);
    std::vector<Region> whole;
    std::priority_queue<Region> toCut;
    toCut.push(sums.region({0, 0}, cells.size()));
    while (!toCut.empty() && int(whole.size() + toCut.size()) < count) {
        const Region region = toCut.top();
        if (!(region.spread > 0)) break;
        toCut.pop();
        if (region.end - region.first == glm::ivec2(1)) {
            whole.push_back(region);
            continue;
        }
        const auto [before, behind] = sums.cut(region);
        toCut.push(before);
        toCut.push(behind);
    }
    for (; !toCut.empty(); toCut.pop()) whole.push_back(toCut.top());
    return whole;
}

Light lightFrom(const Cells& cells, const Region& region, const glm::dmat3& worldFromEnvironment) {
    // Sum again, because differences of sums are not exact.
    Cell all;
    for (int y = region.first.y; y < region.end.y; ++y) {
        for (int x = region.first.x; x < region.end.x; ++x) {
            all.color += cells.at(x, y).color;
            all.moments += cells.at(x, y).moments;
        }
    }
    Light light{LightFrame::kWorld, {0, -1, 0}, glm::dvec3(0), 0};
    const glm::dvec3 irradiance = all.color / std::numbers::pi;
    light.strength = std::max({irradiance.r, irradiance.g, irradiance.b});
    if (light.strength > 0) light.color = irradiance / light.strength;
    // Light from all sides counts as light from above.
    const double length = glm::length(all.moments.way);
    if (length > 1e-9 * all.moments.energy) light.direction = -all.moments.way / length;
    light.direction = worldFromEnvironment * light.direction;
    return light;
}

void requireSound(const Environment& environment, int count) {
    if (count < 1) refuseUsage("`count`", std::to_string(count) + " lights", "1 or more");
    const glm::ivec2 size = environment.sizePixels;
    const std::string text = std::to_string(size.x) + "x" + std::to_string(size.y);
    if (size.y < 1 || size.x != 2 * std::int64_t{size.y}) {
        refuseUsage("`sizePixels`", text, "twice as wide as high");
    }
    if (environment.rgb.size() != 3 * std::size_t(size.x) * std::size_t(size.y)) {
        refuseUsage("`rgb`", std::to_string(environment.rgb.size()) + " values",
                    "three for each of " + text + " pixels");
    }
    const glm::dmat3& turn = environment.worldFromEnvironment;
    const glm::dmat3 product = glm::transpose(turn) * turn;
    bool rotates = glm::determinant(turn) > 0;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            rotates = rotates && std::abs(product[column][row] - (row == column)) < 1e-6;
        }
    }
    if (!rotates) refuseUsage("`worldFromEnvironment`", "no rotation", "a rotation");
}

}  // namespace

std::vector<Light> cutIntoLights(const Environment& environment, int count) {
    const DefaultFloats floats;
    requireSound(environment, count);
    const Cells cells(environment);
    std::vector<Light> lights;
    for (const Region& region : cutIntoRegions(cells, count)) {
        const Light light = lightFrom(cells, region, environment.worldFromEnvironment);
        if (!(light.strength <= kMostLight)) {
            throw Error(ErrorCode::kInput, "environment",
                        "a light of strength " + numberText(light.strength),
                        "at most " + numberText(kMostLight));
        }
        if (light.strength > 0) lights.push_back(light);
    }
    std::stable_sort(lights.begin(), lights.end(),
                     [](const Light& a, const Light& b) { return a.strength > b.strength; });
    return lights;
}

}  // namespace deltasplat
