// SPDX-License-Identifier: Apache-2.0
// Based on: C. Murray, "The Physiological Principle of Minimum Work", 1926 (where a vessel forks,
// the cubes of the radii add up). The rest is a design of this project.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "portable_math.h"
#include "synth/hash.h"
#include "synth/noise.h"
#include "synth/volumes.h"

namespace deltasplat {
namespace {

// A round piece of a vessel, as thick at one end as at the other.
struct Tube {
    glm::dvec3 begin, end;
    double radius;
};

double distanceToAxis(const Tube& tube, const glm::dvec3& p) {
    const glm::dvec3 along = tube.end - tube.begin;
    const double share = glm::dot(p - tube.begin, along) / glm::dot(along, along);
    return glm::distance(p, tube.begin + along * std::clamp(share, 0.0, 1.0));
}

class TreeGrower {
  public:
    explicit TreeGrower(std::uint64_t seed) : random_(seed) {}

    std::vector<Tube> grow() {
        add({0, -0.98, 0}, {0, 1, 0}, 0.45, 0.072, 11);
        return std::move(tubes_);
    }

  private:
    // Grows a vessel and, `forks` times over, the two that it forks into.
    void add(const glm::dvec3& begin, const glm::dvec3& direction, double length, double radius,
             int forks) {
        // What would leave the cube turns back at its wall.
        const double reach = 0.97 - radius;
        const glm::dvec3 end = glm::clamp(begin + direction * length, -reach, reach);
        tubes_.push_back({begin, end, radius});
        if (forks == 0) return;

        const glm::dvec3 helper =
            std::abs(direction.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
        const glm::dvec3 u = glm::normalize(glm::cross(direction, helper));
        const glm::dvec3 v = glm::cross(direction, u);
        const double turn = 2 * std::numbers::pi * random_.next();
        const glm::dvec3 side = u * portable::cos(turn) + v * portable::sin(turn);
        const double share = 0.35 + 0.3 * random_.next();  // of the cube of the radius
        const double angle = 0.45 + 0.4 * random_.next();  // radians between the two
        for (const bool first : {true, false}) {
            const double part = first ? share : 1 - share;
            const double bend = first ? angle * (1 - share) * 2 : -angle * share * 2;
            const glm::dvec3 on = direction * portable::cos(bend) + side * portable::sin(bend);
            add(end, on, length * (0.72 + 0.16 * random_.next()),
                radius * portable::pow(part, 1 / 3.0), forks - 1);
        }
    }

    UnitSequence random_;
    std::vector<Tube> tubes_;
};

// Tells which tubes are near a point.
class TubeMap {
  public:
    explicit TubeMap(std::vector<Tube> tubes)
        : tubes_(std::move(tubes)), near_(std::size_t(kCells) * kCells * kCells) {
        const double halfDiagonal = std::sqrt(3.0) / kCells;
        for (std::uint32_t t = 0; t < tubes_.size(); ++t) {
            const Tube& tube = tubes_[t];
            const glm::ivec3 low = cellOf(glm::min(tube.begin, tube.end) - tube.radius);
            const glm::ivec3 high = cellOf(glm::max(tube.begin, tube.end) + tube.radius);
            for (int z = low.z; z <= high.z; ++z) {
                for (int y = low.y; y <= high.y; ++y) {
                    for (int x = low.x; x <= high.x; ++x) {
                        const glm::dvec3 centre =
                            (2.0 * glm::dvec3(x, y, z) + 1.0) / double(kCells) - 1.0;
                        if (distanceToAxis(tube, centre) <= tube.radius + halfDiagonal * 1.001)
                            near_[placeOf({x, y, z})].push_back(t);
                    }
                }
            }
        }
    }

    double valueAt(const glm::dvec3& p) const {
        constexpr double kSkin = 0.5;  // depth of the full value, as a share of the radius
        double value = 0;
        for (const std::uint32_t t : near_[placeOf(cellOf(p))]) {
            const Tube& tube = tubes_[t];
            const double depth = tube.radius - distanceToAxis(tube, p);
            value = std::max(value, depth / (kSkin * tube.radius));
        }
        return std::min(value, 1.0);
    }

  private:
    static constexpr int kCells = 64;

    static glm::ivec3 cellOf(const glm::dvec3& p) {
        return glm::clamp(glm::ivec3(glm::floor((p + 1.0) * (kCells / 2.0))), 0, kCells - 1);
    }
    static std::size_t placeOf(const glm::ivec3& cell) {
        return (std::size_t(cell.z) * kCells + std::size_t(cell.y)) * kCells + std::size_t(cell.x);
    }

    std::vector<Tube> tubes_;
    std::vector<std::vector<std::uint32_t>> near_;
};

}  // namespace

ValueAt makeVessels(std::uint64_t seed, double noise) {
    const auto map = std::make_shared<const TubeMap>(TreeGrower(seed).grow());
    return withNoise([map](const glm::dvec3& p) { return map->valueAt(p); }, seed, noise);
}

}  // namespace deltasplat
