// SPDX-License-Identifier: Apache-2.0
#include "volume/placement.h"

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

glm::dmat4 withThickness(const glm::dmat4& worldFromIndex, const glm::i64vec3& dims,
                         double thickness) {
    glm::dmat4 whole = worldFromIndex;
    for (int axis = 0; axis < 3; ++axis) {
        if (dims[axis] != 1 || glm::length(glm::dvec3(whole[axis])) > 0) continue;
        const glm::dvec3 normal =
            glm::cross(glm::dvec3(whole[(axis + 1) % 3]), glm::dvec3(whole[(axis + 2) % 3]));
        const double length = glm::length(normal);
        if (length > 0) whole[axis] = glm::dvec4(normal / length * thickness, 0);
    }
    return whole;
}

void scaleLengths(glm::dmat4& worldFromIndex, double factor) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) worldFromIndex[column][row] *= factor;
    }
}

void requirePlacement(const std::string& where, const std::string& what, const glm::dmat4& matrix) {
    if (givesPlaces(matrix)) return;
    throw Error(ErrorCode::kInput, where, what + " that cannot be inverted",
                "finite numbers that give each voxel a place of its own");
}

}  // namespace deltasplat
