// SPDX-License-Identifier: Apache-2.0
#include "ingest/placement.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "deltasplat/error.h"

namespace deltasplat {

bool givesPlaces(const glm::dmat4& worldFromIndex) {
    constexpr double kLeastVolume = 1e-9;  // of a voxel, as a share of its edges' product
    double edges = 1;
    bool usable = glm::length(glm::dvec3(worldFromIndex[3])) <= kMostLength;
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(glm::dvec3(worldFromIndex[axis]));
        usable = usable && length >= 1 / kMostLength && length <= kMostLength;
        edges *= length;
    }
    return usable && std::abs(glm::determinant(glm::dmat3(worldFromIndex))) >= kLeastVolume * edges;
}

void requirePlacement(const std::string& where, const std::string& what, const glm::dmat4& matrix) {
    if (givesPlaces(matrix)) return;
    throw Error(ErrorCode::kInput,
                gotExpected(where, what + " that cannot be inverted",
                            "finite numbers that give each voxel a place of its own"));
}

}  // namespace deltasplat
