// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "deltasplat/ingest/make_volume.h"
#include "deltasplat/optics/class_table.h"

// Fog that scatters light, and formulas of the documentation to hold it against.

namespace deltasplat::test {

inline constexpr double kPi = std::numbers::pi;

/// Returns a volume of opacities over a unit of the world.
inline Volume fogOf(const glm::ivec3& dims, const glm::dmat4& worldFromIndex,
                    const std::function<double(const glm::dvec3& world)>& extinctionAt) {
    std::vector<float> values;
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x) {
                const glm::dvec3 world(worldFromIndex * glm::dvec4(x, y, z, 1));
                values.push_back(float(-std::expm1(-extinctionAt(world))));
            }
        }
    }
    MemoryLayout layout;
    layout.dims = dims;
    layout.worldFromIndex = worldFromIndex;
    return makeVolume<float>(values, layout);
}

/// Returns what makes white fog of it.
inline Optics fogOptics(const Scattering& scattering) {
    Optics optics;
    optics.transferFunction.colors = {{0, glm::dvec3(1)}};
    optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {1, 1, 0.5, 0}};
    optics.unitDistance = 1;
    optics.scattering = scattering;
    return optics;
}

/// Returns a point light of strength 1.
inline Light pointAt(const glm::dvec3& world) {
    Light light{LightFrame::kWorld};
    light.positionWorld = world;
    return light;
}

/// Returns the place of voxels of one size about the middle of a cube of n of them.
inline glm::dmat4 aroundMiddle(int n, double voxel) {
    glm::dmat4 world(voxel);
    world[3] = glm::dvec4(glm::dvec3(-0.5 * voxel * (n - 1)), 1);
    return world;
}

/// A ball of density exp(-r^2 / 2 w^2) times that of its middle.
struct Ball {
    double middle;
    double width;

    double extinctionAt(const glm::dvec3& p) const {
        return middle * std::exp(-glm::dot(p, p) / (2 * width * width));
    }
    /// On the way from infinity to p, or only so far back.
    double depthAt(const glm::dvec3& p, const glm::dvec3& way, double back = 1e300) const {
        const double t = glm::dot(p, way);
        const double beside = glm::dot(p, p) - t * t;
        const double scale = 1 / (width * std::sqrt(2.0));
        return middle * std::exp(-beside / (2 * width * width)) * width * std::sqrt(kPi / 2) *
               (std::erf(t * scale) - std::erf((t - back) * scale));
    }
    double depthBetween(const glm::dvec3& from, const glm::dvec3& to) const {
        const double distance = glm::distance(from, to);
        return distance > 0 ? depthAt(to, (to - from) / distance, distance) : 0;
    }
};

inline double henyeyGreenstein(double g, double cosine) {
    return (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

inline double phaseOf(const Scattering& fog, int octave, double cosine) {
    const double part = std::pow(0.5, octave);
    return (1 - fog.backShare) * henyeyGreenstein(part * fog.anisotropy, cosine) +
           fog.backShare * henyeyGreenstein(part * fog.backAnisotropy, cosine);
}

}  // namespace deltasplat::test
