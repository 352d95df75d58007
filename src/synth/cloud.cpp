// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "synth/gradient_noise.h"
#include "synth/volumes.h"

namespace deltasplat {

ValueAt makeCloud(std::uint64_t seed) {
    return [seed](const glm::dvec3& p) {
        // Bulges grow out of a flattened ball; density rises with the depth below their surface.
        constexpr glm::dvec3 kHalfAxes(0.92, 0.7, 0.85);
        constexpr double kCore = 0.42;      // share of the radius that the deepest crease leaves
        constexpr double kFrequency = 2.2;  // lattice cells per unit, largest octave
        constexpr double kSkin = 0.55;      // depth of full density, as a share of the radius
        const glm::dvec3 q = p / kHalfAxes;
        const double radius = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
        if (radius >= 1) return 0.0;
        const double depth = kCore + (1 - kCore) * billowAt(seed, p * kFrequency) - radius;
        return std::clamp(depth / kSkin, 0.0, 1.0);
    };
}

}  // namespace deltasplat
