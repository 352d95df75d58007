// SPDX-License-Identifier: Apache-2.0
// Based on: a design of this project, in the manner of the volume library's CT engine.
#include <algorithm>
#include <cmath>

#include "synth/noise.h"
#include "synth/volumes.h"

namespace deltasplat {
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

// Distance from an axis along x, y or z is a distance in the other two coordinates.
double distance(double a, double b) {
    return std::sqrt(a * a + b * b);
}

// What one cylinder holds, with x counted from its axis; `pistonY` is the piston's lower edge.
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

// The casting around the cylinders, ports and water jacket taken out; `radius` is the distance from
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

}  // namespace deltasplat
