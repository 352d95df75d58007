// SPDX-License-Identifier: Apache-2.0
// Based on: N. Max, Optical Models for Direct Volume Rendering, 1995 (absorption plus emission:
// what shines evenly along a way of depth t, of which 1 - exp(-t) is swallowed, comes out of it
// with (1 - exp(-t)) / t of itself).
#include "lighting/medium_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "base/portable_math.h"
#include "optics/color_space.h"

namespace deltasplat {
namespace {

// What is more opaque cannot be told from it.
constexpr double kMostDepth = 1e30;
// A step that adds more than this has parts that are too coarsely told on one plane: to 2^-25.
constexpr double kMostOnPlane = 64;

double dimmedBy(double depth) {
    if (depth < 1e-9) return 1;
    return -portable::expm1(-depth) / depth;
}

double stepsOf(const ClassTable& classes) {
    return classes.stepWorld / classes.unitDistanceWorld;
}

double depthOf(const PartLook& look, double unitDistances) {
    return look.extinction > 0 ? std::min(look.extinction * unitDistances, kMostDepth) : 0;
}

// The largest that a channel gets in a step, beside what the inner light shows.
glm::dvec4 mostOf(const std::vector<PartLooks>& parts, double unitDistances) {
    glm::dvec4 most(0);
    for (const PartLooks& part : parts) {
        const PartLook largest = part.largest();
        const double alpha = -portable::expm1(-depthOf(largest, unitDistances));
        most += glm::dvec4(alpha * largest.color + unitDistances * largest.glow, 0);
    }
    return most;
}

// What a unit of one light is of another's, at least of any channel.
double smallestShare(const VoxelUnits& inner, const VoxelUnits& units) {
    double share = 1;
    for (int c = 0; c < 4; ++c)
        if (inner.scale()[c] > 0) share = std::min(share, inner.scale()[c] / units.scale()[c]);
    return share;
}

// Units for all that a voxel may show.
VoxelUnits unitsFor(const LookLight& inner, const std::vector<PartLooks>& parts,
                    const glm::dvec3* factor, const ClassTable& classes) {
    VoxelUnits units = inner.units();
    const double unitDistances = stepsOf(classes);
    double depth = 0;
    for (const double one : depthsOf(classes, classes.stepWorld)) depth = std::max(depth, one);
    for (const PartLooks& part : parts) depth += depthOf(part.largest(), unitDistances);
    glm::dvec4 most = units.scale() * double(ClassTable::kMax);
    if (factor) most *= glm::dvec4(*factor, 1);
    most += mostOf(parts, unitDistances);
    most.a = std::max(most.a, -portable::expm1(-depth));
    units.raise(most);
    return units;
}

}  // namespace

MediumLight::MediumLight(std::unique_ptr<const LookLight> inner,
                         const std::vector<PartLooks>& parts, const glm::dvec3* factor,
                         const ClassTable& classes)
    : MediumLight(unitsFor(*inner, parts, factor, classes), std::move(inner), parts, factor,
                  classes) {}

MediumLight::MediumLight(const VoxelUnits& common, std::unique_ptr<const LookLight>&& inner,
                         const std::vector<PartLooks>& parts, const glm::dvec3* factor,
                         const ClassTable& classes)
    : LookLight(common, inner->dimmest() * smallestShare(inner->units(), common)),
      inner_(std::move(inner)),
      hasFactors_(factor != nullptr) {
    const glm::dvec4 scale = units().scale();
    for (int c = 0; c < 4; ++c)
        fromInner_[c] = scale[c] > 0 ? float(inner_->units().scale()[c] / scale[c]) : 0;
    if (factor) factor_ = glm::vec3(*factor);
    if (inner_->isFine()) setFine();
    findLooks(parts, classes);
}

void MediumLight::findLooks(const std::vector<PartLooks>& parts, const ClassTable& classes) {
    const glm::dvec4& scale = units().scale();
    const double unitDistances = stepsOf(classes);
    glm::dvec3 toUnits(0);
    for (int c = 0; c < 3; ++c) toUnits[c] = scale[c] > 0 ? 1 / scale[c] : 0;
    for (const PartLooks& part : parts) {
        std::vector<StepLook>& looks = looks_.emplace_back();
        for (const PartLook& look : part.looks) {
            const double depth = depthOf(look, unitDistances);
            looks.push_back({float(depth), glm::vec3(look.color * toUnits),
                             glm::vec3(look.glow * unitDistances * toUnits)});
            absorbs_ = absorbs_ || depth > 0;
        }
        const glm::dvec3 glow = unitDistances * part.largest().glow;
        if (std::max({glow.x, glow.y, glow.z}) > kMostOnPlane) setFine();
    }
    for (const double one : depthsOf(classes, classes.stepWorld)) {
        const double depth = std::min(one, kMostDepth);
        classes_.push_back({float(depth), float(dimmedBy(depth))});
    }
}

void MediumLight::lightVoxels(const WordPlace& place, const std::uint16_t* classes,
                              const OwnLook* looks, WordUnits& colors) const {
    inner_->light(place, classes, looks, colors);
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t n = 0; n < 64; ++n) colors[c][n] *= fromInner_[int(c)];
    if (hasFactors_) {
        const WordFactors factors = factorsOf(looks);
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t n = 0; n < 64; ++n) colors[c][n] *= factor_[int(c)] * factors[c][n];
    }
    if (absorbs_) {
        addParts(classes, looks, colors);
    } else {
        addGlow(classes, looks, colors);
    }
}

// Of parts that only shine, classes tell how dim they become.
void MediumLight::addGlow(const std::uint16_t* classes, const OwnLook* looks,
                          WordUnits& colors) const {
    for (std::size_t part = 0; part < looks_.size(); ++part) {
        for (std::size_t n = 0; n < 64; ++n) {
            const std::uint16_t look = looks[n].bits[part];
            if (look == 0) continue;
            const glm::vec3 glow = classes_[classes[n]].dimmed * looks_[part][look].glow;
            for (int c = 0; c < 3; ++c) colors[std::size_t(c)][n] += glow[c];
        }
    }
}

// Every part has the share of the common opacity that its depth is of the common depth.
void MediumLight::addParts(const std::uint16_t* classes, const OwnLook* looks,
                           WordUnits& colors) const {
    const double opaque = units().unitsOfOpaque();
    for (std::size_t n = 0; n < 64; ++n) {
        const double own = classes_[classes[n]].depth;
        double depth = own;
        glm::dvec3 shines(0);
        bool isAny = false;
        for (std::size_t part = 0; part < looks_.size(); ++part) {
            const std::uint16_t number = looks[n].bits[part];
            if (number == 0) continue;
            isAny = true;
            const StepLook& look = looks_[part][number];
            depth += look.depth;
            shines += double(look.depth) * glm::dvec3(look.color) + glm::dvec3(look.glow);
        }
        if (!isAny) continue;
        const double dimmed = dimmedBy(depth);
        // Of what is its own, as much less as it is dimmed more than by itself.
        const double left = dimmed / classes_[classes[n]].dimmed;
        for (int c = 0; c < 3; ++c) {
            float& channel = colors[std::size_t(c)][n];
            channel = float(channel * left + dimmed * shines[c]);
        }
        colors[3][n] = float(dimmed * depth * opaque);
    }
}

}  // namespace deltasplat
