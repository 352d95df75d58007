// SPDX-License-Identifier: Apache-2.0
// Body: designed for this project; no measures of a real person. Engine: likewise, in the manner of
// the volume library's CT engine.
// Based on: L. Shepp, B. Logan, "The Fourier Reconstruction of a Head Section", 1974 (ellipses); P.
// Toft, "The Radon Transform", 1996, table B.3 (visible contrasts); M. Schabel's 3D version, 2005
// (third axes, positions along z). The ventricles are rotated about z only.
// Based on: C. Murray, "The Physiological Principle of Minimum Work", 1926 (at a fork the cubes of
// the radii add up); otherwise designed for this project.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "base/portable_math.h"
#include "synth/noise.h"
#include "synth/volumes.h"

namespace deltasplat {

namespace {

enum Label {
    kNothing,
    kSkin,
    kBone,
    kLung,
    kHeart,
    kLiver,
    kStomach,
    kKidney,
    kSpleen,
    kBowel,
    kBrain,
    kAorta
};

bool inEllipsoid(const glm::dvec3& p, const glm::dvec3& centre, const glm::dvec3& half) {
    const glm::dvec3 q = (p - centre) / half;
    return glm::dot(q, q) <= 1;
}

bool inCapsule(const glm::dvec3& p, const glm::dvec3& begin, const glm::dvec3& end, double radius) {
    const glm::dvec3 along = end - begin;
    const double share = glm::dot(p - begin, along) / glm::dot(along, along);
    const glm::dvec3 rest = p - begin - along * std::clamp(share, 0.0, 1.0);
    return glm::dot(rest, rest) <= radius * radius;
}

// Mirrors paired parts onto one side.
glm::dvec3 onLeft(const glm::dvec3& p) {
    return {std::abs(p.x), p.y, p.z};
}

// Half the trunk's width at a height.
double breadthAt(double y) {
    const double chest = 0.46 - 0.5 * (y - 0.12) * (y - 0.12);
    const double hip = 0.42 - 0.6 * (y + 0.75) * (y + 0.75);
    return std::max(chest, hip);
}

bool isTrunk(const glm::dvec3& p) {
    if (p.y < -0.95 || p.y > 0.5) return false;
    const double x = p.x / breadthAt(p.y);
    const double z = p.z / (0.27 - 0.06 * p.y * p.y);
    return x * x * std::abs(x) + z * z * std::abs(z) <= 1;
}

bool isSkin(const glm::dvec3& p) {
    const glm::dvec3 q = onLeft(p);
    return isTrunk(p) || inEllipsoid(p, {0, 0.78, 0.02}, {0.15, 0.2, 0.18}) ||
           inCapsule(p, {0, 0.4, -0.03}, {0, 0.7, -0.02}, 0.1) ||
           inCapsule(q, {0.1, 0.38, -0.02}, {0.45, 0.33, -0.02}, 0.1) ||
           inCapsule(q, {0.5, 0.3, -0.02}, {0.62, -0.25, 0}, 0.075) ||
           inCapsule(q, {0.62, -0.25, 0}, {0.64, -0.75, 0.1}, 0.055) ||
           inEllipsoid(p, {0, 0.75, 0.2}, {0.025, 0.045, 0.04});
}

// Twelve pairs that slope down towards the front and end beside the breast bone.
bool isRib(const glm::dvec3& p) {
    for (int rib = 0; rib < 12; ++rib) {
        const double side = rib < 9 ? 1 : 1 - 0.22 * (rib - 8);
        const double top = 0.4 - 0.062 * rib;
        const double bow = std::min(1.0, 0.62 + 0.09 * rib);
        const glm::dvec2 half(0.36 * bow * (rib > 9 ? 0.95 : 1), 0.225 * bow);
        const glm::dvec2 round(p.x / half.x, (p.z + 0.01) / half.y);
        const double radius = glm::length(round);
        const double height = top - 0.16 * (p.z + 0.2) - p.y;
        const double beyond = (radius - 1) * 0.5 * (half.x + half.y);
        const bool isOpen = p.z > -0.24 + 0.4 * side && std::abs(p.x) < 0.3 * side;
        if (!isOpen && beyond * beyond + 0.6 * height * height <= 0.017 * 0.017) return true;
    }
    return false;
}

bool isSpine(const glm::dvec3& p) {
    if (p.y < -0.72 || p.y > 0.66) return false;
    const double bend = -0.17 + 0.04 * portable::sin(4.5 * p.y);
    const double ring = 0.045 + 0.01 * portable::cos(90 * p.y);
    const glm::dvec2 round(p.x, p.z - bend);
    const bool isThorn = std::abs(p.x) < 0.012 && p.z < bend && p.z > bend - 0.085;
    return glm::length(round) <= ring || (isThorn && portable::cos(90 * p.y) > 0);
}

bool isBone(const glm::dvec3& p) {
    const glm::dvec3 q = onLeft(p);
    const bool isSkull = inEllipsoid(p, {0, 0.8, 0.01}, {0.13, 0.165, 0.155}) &&
                         !inEllipsoid(p, {0, 0.82, -0.005}, {0.115, 0.135, 0.135}) &&
                         !inEllipsoid(q, {0.055, 0.79, 0.15}, {0.032, 0.028, 0.04}) &&
                         !inEllipsoid(p, {0, 0.73, 0.17}, {0.02, 0.03, 0.05});
    const bool isPelvis = inEllipsoid(q, {0.19, -0.66, -0.03}, {0.16, 0.17, 0.16}) &&
                          !inEllipsoid(q, {0.17, -0.62, 0.05}, {0.15, 0.18, 0.17}) &&
                          !inEllipsoid(p, {0, -0.75, 0.0}, {0.12, 0.16, 0.14});
    return isSkull || isPelvis || isRib(p) || isSpine(p) ||
           inCapsule(p, {0, 0.33, 0.185}, {0, 0.06, 0.225}, 0.02) ||
           inCapsule(q, {0.03, 0.37, 0.16}, {0.4, 0.4, -0.05}, 0.018) ||
           inCapsule(q, {0.5, 0.3, -0.02}, {0.61, -0.22, 0}, 0.03) ||
           inCapsule(q, {0.6, -0.28, 0.01}, {0.62, -0.72, 0.1}, 0.017) ||
           inCapsule(q, {0.64, -0.28, -0.01}, {0.655, -0.72, 0.08}, 0.015) ||
           inCapsule(q, {0.28, -0.75, 0.0}, {0.27, -0.93, 0.02}, 0.045);
}

bool isBowel(const glm::dvec3& p) {
    if (!inEllipsoid(p, {0, -0.42, 0.07}, {0.24, 0.19, 0.12})) return false;
    // Adjacent loops.
    const double loops = portable::sin(34 * p.x + 3 * portable::sin(21 * p.y)) +
                         portable::sin(38 * p.y + 2 * portable::sin(17 * p.z));
    return loops > -0.5;
}

Label labelAt(const glm::dvec3& p) {
    if (!isSkin(p)) return kNothing;
    if (isBone(p)) return kBone;
    if (inEllipsoid(p, {0, 0.82, -0.005}, {0.108, 0.128, 0.128})) return kBrain;
    if (inCapsule(p, {0.015, 0.28, -0.07}, {0.015, -0.5, -0.1}, 0.024)) return kAorta;
    if (inEllipsoid(p, {0.05, 0.11, 0.07}, {0.105, 0.125, 0.09})) return kHeart;
    if (inEllipsoid(onLeft(p), {0.185, 0.15, -0.01}, {0.125, 0.25, 0.16})) return kLung;
    if (inEllipsoid(p, {-0.12, -0.13, 0.03}, {0.19, 0.12, 0.15})) return kLiver;
    if (inEllipsoid(p, {0.15, -0.14, 0.06}, {0.1, 0.09, 0.08})) return kStomach;
    if (inEllipsoid(p, {0.25, -0.11, -0.09}, {0.05, 0.085, 0.06})) return kSpleen;
    if (inEllipsoid(onLeft(p), {0.15, -0.3, -0.12}, {0.048, 0.09, 0.045})) return kKidney;
    if (isBowel(p)) return kBowel;
    return kSkin;
}

}  // namespace

ValueAt makeBody() {
    return [](const glm::dvec3& p) { return double(labelAt(p)) / 255; };
}

namespace {

constexpr double kAluminium = 0.45;
constexpr double kSteel = 0.9;
constexpr double kCylinderX = 0.38;  // the cylinders stand at x = -kCylinderX and +kCylinderX
constexpr double kCrankY = -0.62;
constexpr double kBore = 0.25;  // radius of the cylinders' inside

bool within(double value, double low, double high) {
    return value >= low && value <= high;
}

bool inBox(const glm::dvec3& p, double halfX, double lowY, double highY, double halfZ) {
    return std::abs(p.x) <= halfX && within(p.y, lowY, highY) && std::abs(p.z) <= halfZ;
}

// Distance from an axis along x, y or z, given the other two coordinates.
double distance(double a, double b) {
    return std::sqrt(a * a + b * b);
}

// Value inside one cylinder, x relative to its axis; `pistonY` is the piston's lower edge.
double cylinderValue(const glm::dvec3& p, double pistonY) {
    const double radius = distance(p.x, p.z);
    const bool piston = radius <= kBore - 0.025 && within(p.y, pistonY, pistonY + 0.24);
    const bool hollow = radius <= kBore - 0.085 && p.y < pistonY + 0.17;
    const bool pin = distance(p.x, p.y - pistonY - 0.1) <= 0.05 && std::abs(p.z) <= kBore - 0.025;
    const bool rod =
        std::abs(p.x) <= 0.045 && std::abs(p.z) <= 0.07 && within(p.y, kCrankY, pistonY + 0.1);
    if (pin || rod) return kSteel;
    return piston && !hollow ? kAluminium : 0;
}

bool isSteel(const glm::dvec3& p) {
    const bool crankShaft = distance(p.y - kCrankY, p.z) <= 0.1 && std::abs(p.x) <= 0.95;
    const bool flywheel = distance(p.y - kCrankY, p.z) <= 0.3 && within(p.x, 0.84, 0.93);
    const bool bolts =
        distance(std::abs(p.x) - 0.76, std::abs(p.z) - 0.36) <= 0.05 && within(p.y, 0.2, 0.78);
    return crankShaft || flywheel || bolts;
}

// The casting around the cylinders, without ports and water jacket; `radius` is the distance from
// the nearer cylinder's axis.
bool isCasting(const glm::dvec3& p, double radius) {
    const bool block = inBox(p, 0.72, -0.32, 0.5, 0.42) || inBox(p, 0.84, 0.5, 0.62, 0.46);
    const bool jacket = within(radius, 0.33, 0.375) && within(p.y, -0.15, 0.42) &&
                        std::abs(p.x) < 0.68 && std::abs(p.z) < 0.38;
    const bool port =
        distance(std::abs(p.x) - kCylinderX, p.y - 0.42) <= 0.09 && p.z > kBore - 0.02;
    const bool case_ = inBox(p, 0.8, -0.9, -0.32, 0.46) && !inBox(p, 0.72, -0.82, -0.32, 0.38);
    const bool bearing =
        (std::abs(p.x) <= 0.06 || std::abs(p.x) >= 0.66) && inBox(p, 0.76, -0.8, -0.32, 0.24);
    return (block && !jacket && !port) || case_ || bearing;
}

double engineValue(const glm::dvec3& p) {
    if (isSteel(p)) return kSteel;
    const glm::dvec3 local(std::abs(p.x) - kCylinderX, p.y, p.z);
    const double radius = distance(local.x, local.z);
    // The pistons are half a turn apart.
    const double inside = cylinderValue(local, p.x < 0 ? 0.2 : -0.2);
    if (inside > 0) return inside;

    // Steel liners hold the bores, which reach into the crank case.
    if (radius <= kBore && within(p.y, -0.4, 0.62)) return 0;
    if (radius <= kBore + 0.045 && within(p.y, -0.4, 0.5)) return kSteel;
    return isCasting(p, radius) ? kAluminium : 0;
}

}  // namespace

ValueAt makeEngine(std::uint64_t seed, double noise) {
    return withNoise(engineValue, seed, noise);
}

namespace {

struct Ellipsoid {
    int tenths;           // added inside, in tenths of the value range
    glm::dvec3 halfAxes;  // before rotation
    glm::dvec3 centre;
    double turnDegrees;  // about z, counter-clockwise
};

const Ellipsoid kHead[] = {{10, {0.69, 0.92, 0.81}, {0, 0, 0}, 0},           // skull
                           {-8, {0.6624, 0.874, 0.78}, {0, -0.0184, 0}, 0},  // brain
                           {-2, {0.11, 0.31, 0.22}, {0.22, 0, 0}, -18},      // right ventricle
                           {-2, {0.16, 0.41, 0.28}, {-0.22, 0, 0}, 18},      // left ventricle
                           {1, {0.21, 0.25, 0.41}, {0, 0.35, -0.15}, 0},     // the rest are tumours
                           {1, {0.046, 0.046, 0.05}, {0, 0.1, 0.25}, 0},     //
                           {1, {0.046, 0.046, 0.05}, {0, -0.1, 0.25}, 0},    //
                           {1, {0.046, 0.023, 0.05}, {-0.08, -0.605, 0}, 0},  //
                           {1, {0.023, 0.023, 0.02}, {0, -0.606, 0}, 0},      //
                           {1, {0.023, 0.046, 0.02}, {0.06, -0.605, 0}, 0}};

bool isInside(const Ellipsoid& ellipsoid, const glm::dvec3& p) {
    const double turn = ellipsoid.turnDegrees * std::numbers::pi / 180;
    const glm::dvec3 d = p - ellipsoid.centre;
    const double x = (d.x * portable::cos(turn) + d.y * portable::sin(turn)) / ellipsoid.halfAxes.x;
    const double y = (d.y * portable::cos(turn) - d.x * portable::sin(turn)) / ellipsoid.halfAxes.y;
    const double z = d.z / ellipsoid.halfAxes.z;
    return x * x + y * y + z * z <= 1;
}

}  // namespace

ValueAt makeSheppLogan() {
    return [](const glm::dvec3& p) {
        // Sums of integers are exact, so empty places are exactly 0.
        int tenths = 0;
        for (const Ellipsoid& ellipsoid : kHead) {
            if (isInside(ellipsoid, p)) tenths += ellipsoid.tenths;
        }
        return tenths > 0 ? tenths / 10.0 : 0.0;
    };
}

namespace {

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
    // Grows a vessel and its branches, up to `forks` generations.
    void add(const glm::dvec3& begin, const glm::dvec3& direction, double length, double radius,
             int forks) {
        // A vessel that would leave the cube ends at its wall.
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
