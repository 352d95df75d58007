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

/// What one octave of fog scatters towards the camera, as a function of the cosine c of the angle
/// between the way of light before and after: the sum over lobes of k / (a - b c)^1.5, 1 being what
/// a white surface does that faces a light (Scattering).
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
    /// The most that it is anywhere, and the least.
    double largest() const;
    double smallest() const;
};

/// Returns the share of light that is left in a voxel where the camera sees it, on average: lit
/// from the front, from a side, from behind; the last is not used.
/// @param depth  extinction on the way through it, >= 0, may be infinite
glm::vec4 ownLight(double depth);

/// Returns the phase of each octave, [octaves + 1], its strength included.
std::vector<ScatterPhase> phasesOf(const Scattering& scattering);

/// A light, as the kernel takes it.
struct ScatterRay {
    glm::vec3 way;  ///< that light travels, of length 1
    glm::vec3 color;
    float cosine;  ///< between its way and that to the camera, where all see it from one side
    /// [octaves + 1]: colour times what is scattered towards the camera, where all see it from one
    /// side.
    std::vector<glm::vec3> towardsCamera;
    /// It shines from a point, towards each voxel another way: the others are of no effect, but for
    /// its colour, which it has where ways to it are of length 1 or less.
    bool isPoint = false;
};

/// What voxels scatter (Scattering).
struct ScatterSums {
    glm::vec3 ambient;
    std::vector<ScatterPhase> phases;  ///< [octaves + 1]
    std::vector<ScatterRay> rays;
    glm::vec3 toCamera;  ///< of length 1, where all see it from one side
};

/// What is lit.
struct ScatterWord {
    const glm::vec4* colors;  ///< of classes, premultiplied
    const glm::vec4* own;     ///< of classes: ownLight()
    const glm::vec4* sentOn;  ///< of classes: colour times albedo; of use to octaves alone
    /// [3][64]: what each voxel's is multiplied by; null if by nothing.
    const WordFactors* factors;
    const std::uint16_t* classes;  ///< [64]
    const std::uint16_t* depths;   ///< [rays][64]: as LightDepths has them
    const WaysToEye* ways;         ///< null if all see it from one side
    const WaysToEye* toLights;     ///< to those that shine from a point, one after the other
};

/// Returns the premultiplied colours that voxels scatter. The same bits at every SIMD level.
void scatter(const ScatterSums& sums, const ScatterWord& word, WordUnits& units);

}  // namespace deltasplat
