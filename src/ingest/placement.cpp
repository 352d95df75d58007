// SPDX-License-Identifier: Apache-2.0
#include "ingest/placement.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "deltasplat/error.h"

namespace deltasplat {

void requirePlacement(const std::string& where, const std::string& what, const glm::dmat4& matrix) {
    constexpr double kMost = 1e15;
    constexpr double kLeastVolume = 1e-9;  // of a voxel, as a share of its edges' product
    double edges = 1;
    bool usable = glm::length(glm::dvec3(matrix[3])) <= kMost;
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(glm::dvec3(matrix[axis]));
        usable = usable && length >= 1 / kMost && length <= kMost;
        edges *= length;
    }
    const double volume = std::abs(glm::determinant(glm::dmat3(matrix)));
    if (usable && volume >= kLeastVolume * edges) return;
    throw Error(ErrorCode::kInput,
                gotExpected(where, what + " that cannot be inverted",
                            "finite numbers that give each voxel a place of its own"));
}

}  // namespace deltasplat
