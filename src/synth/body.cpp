// SPDX-License-Identifier: Apache-2.0
// Based on: a design of this project; no measure of it is anybody's.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "portable_math.h"
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

// The other side of what is there twice.
glm::dvec3 onLeft(const glm::dvec3& p) {
    return {std::abs(p.x), p.y, p.z};
}

// Half the breadth of the trunk, at each height.
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

// Twelve pairs that fall towards the front, where they end beside the breast bone.
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
    // Loops side by side.
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

}  // namespace deltasplat
