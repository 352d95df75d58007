// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "deltasplat/optics/scattering.h"
#include "lighting/ways_to_eye.h"
#include "optics/color_space.h"
#include "optics/voxel_units.h"

namespace deltasplat {

/// Scattering of one octave of fog towards the camera, relative to a white surface that faces the
/// light: the sum over lobes of k / (a - b c)^1.5, with c the cosine of the angle of deflection.
struct ScatterPhase {
    struct Lobe {
        float k, a, b;

        double at(double cosine) const {
            const double rest = a - b * cosine;
            return k / (rest * std::sqrt(rest));
        }
    };
    std::array<Lobe, 2> lobes;

    double at(double cosine) const;
    double largest() const;
    double smallest() const;
};

/// Returns the average share of light left at the visible depth of a voxel that is lit from the
/// front, from a side and from behind; the last component is unused.
/// @param depth  extinction through the voxel, >= 0, may be infinite
glm::vec4 ownLight(double depth);

/// Returns the phase of each octave, [octaves + 1], including its strength.
std::vector<ScatterPhase> phasesOf(const Scattering& scattering);

struct ScatterRay {
    glm::vec3 way;  ///< of the light, of length 1
    glm::vec3 color;
    float cosine;  ///< of the deflection; for parallel lines of sight
    /// [octaves + 1]: colour times scattering towards the camera; for parallel lines of sight.
    std::vector<glm::vec3> towardsCamera;
    /// A point light has only a colour, valid at distances (WaysToEye) of 1 or less.
    bool isPoint = false;
};

struct ScatterSums {
    glm::vec3 ambient;
    std::vector<ScatterPhase> phases;  ///< [octaves + 1]
    std::vector<ScatterRay> rays;
    glm::vec3 toCamera;  ///< of length 1; for parallel lines of sight
};

/// Voxels of a word to be lit.
struct ScatterWord {
    const glm::vec4* colors;  ///< of classes, premultiplied
    const glm::vec4* own;     ///< of classes: ownLight()
    const glm::vec4* sentOn;  ///< of classes: colour times albedo; only for octaves
    /// [3][64]: factors of the voxels' `sentOn`; null: all 1.
    const WordFactors* factors;
    const std::uint16_t* classes;  ///< [64]
    const std::uint16_t* depths;   ///< [rays][64]: see LightDepths
    const WaysToEye* ways;         ///< null for parallel lines of sight
    const WaysToEye* toLights;     ///< to the point lights, one after the other
};

/// Returns the premultiplied scattered colours. The same bits at every SIMD level.
void scatter(const ScatterSums& sums, const ScatterWord& word, WordUnits& units);

}  // namespace deltasplat
