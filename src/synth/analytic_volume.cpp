// SPDX-License-Identifier: Apache-2.0
// Based on: S. Marschner, R. Lobb, "An Evaluation of Reconstruction Filters for Volume Rendering",
// 1994, section 5 (marschner-lobb); D. Griffiths, "Introduction to Quantum Mechanics", 1995,
// section 4.2 (hydrogen: radial function R_32 and spherical harmonic Y_20).

#include <cmath>
#include <numbers>

#include "base/default_floats.h"
#include "base/portable_math.h"
#include "deltasplat/error.h"
#include "deltasplat/synth/analytic_volume.h"
#include "synth/volumes.h"

namespace deltasplat {

ValueAt makeMarschnerLobb() {
    return [](const glm::dvec3& p) {
        constexpr double kPi = std::numbers::pi;
        constexpr double kFrequency = 6;  // f_M
        constexpr double kAlpha = 0.25;
        const double radius = std::sqrt(p.x * p.x + p.y * p.y);
        const double ripple = portable::cos(2 * kPi * kFrequency * portable::cos(kPi * radius / 2));
        return (1 - portable::sin(kPi * p.z / 2) + kAlpha * (1 + ripple)) / (2 * (1 + kAlpha));
    };
}

ValueAt makeHydrogen() {
    return [](const glm::dvec3& p) {
        // |psi|^2 ~ (r^2 exp(-r/3) (3 cos^2 theta - 1))^2 with r in Bohr radii and theta from
        // the y axis, which is up.
        constexpr double kHalfEdge = 20;
        const glm::dvec3 q = p * kHalfEdge;
        const double radius = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
        const double psi = (2 * q.y * q.y - q.x * q.x - q.z * q.z) * portable::exp(-radius / 3);
        // On the y axis psi is 2 y^2 exp(-y/3), which is largest at y = 6.
        const double largest = 72 * portable::exp(-2.0);
        return (psi / largest) * (psi / largest);
    };
}

ValueAt makeSlab() {
    return [](const glm::dvec3& p) {
        const bool inside = std::abs(p.x) <= 0.8 && std::abs(p.y) <= 0.8 && std::abs(p.z) <= 0.5;
        return inside ? 1.0 : 0.0;
    };
}

const std::vector<std::string>& analyticNames() {
    static const std::vector<std::string> kNames = {
        "marschner-lobb", "hydrogen", "shepp-logan", "engine", "cloud",
        "slab",           "vessels",  "body",        "fire",   "explosion"};
    return kNames;
}

AnalyticVolume makeAnalytic(const std::string& name, std::uint64_t seed, double noise) {
    const DefaultFloats floats;
    if (!(noise >= 0) || !std::isfinite(noise)) {
        throw Error(ErrorCode::kUsage, "`noise`", std::to_string(noise), "a number of at least 0");
    }
    if (name == "marschner-lobb") return {name, makeMarschnerLobb()};
    if (name == "hydrogen") return {name, makeHydrogen()};
    if (name == "shepp-logan") return {name, makeSheppLogan()};
    if (name == "engine") return {name, makeEngine(seed, noise)};
    if (name == "cloud") return {name, makeCloud(seed)};
    if (name == "slab") return {name, makeSlab()};
    if (name == "vessels") return {name, makeVessels(seed, noise)};
    if (name == "body") return {name, makeBody()};
    if (name == "fire") return makeFire(seed);
    if (name == "explosion") return makeExplosion(seed);

    std::string names;
    for (const std::string& known : analyticNames()) names += (names.empty() ? "" : ", ") + known;
    throw Error(ErrorCode::kUsage, "`name`", "\"" + name + "\"", "one of " + names);
}

}  // namespace deltasplat
