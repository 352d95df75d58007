// SPDX-License-Identifier: Apache-2.0
#include "view/affine.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "deltasplat/error.h"
#include "number_text.h"

namespace deltasplat {

void requireInvertible(const glm::dmat4& worldFromIndex) {
    const glm::dmat3 linear(worldFromIndex);
    const double edges = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
    const double volume = std::abs(glm::determinant(linear));
    const glm::dvec3 origin(worldFromIndex[3]);

    // Relative to the edges, so that neither tiny nor huge voxels are taken for flat ones.
    const bool finite = std::isfinite(edges) && std::isfinite(volume) &&
                        std::isfinite(origin.x + origin.y + origin.z);
    if (finite && volume > 1e-12 * edges) return;
    throw Error(ErrorCode::kInput,
                gotExpected("worldFromIndex", "voxels of volume " + numberText(volume),
                            "a finite transform that can be inverted"));
}

}  // namespace deltasplat
