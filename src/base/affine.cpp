// SPDX-License-Identifier: Apache-2.0
#include "base/affine.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <string>

#include "base/text.h"
#include "deltasplat/error.h"

namespace deltasplat {

void requireInvertible(const glm::dmat4& worldFromIndex) {
    const glm::dmat3 linear(worldFromIndex);
    const glm::dvec3 edges(glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]));
    const double box = edges.x * edges.y * edges.z;
    const double volume = std::abs(glm::determinant(linear));
    const glm::dvec3 origin(worldFromIndex[3]);

    // Relative to the edges, so that neither tiny nor huge voxels are taken for flat ones.
    const bool finite = std::isfinite(box) && std::isfinite(volume) &&
                        std::isfinite(origin.x + origin.y + origin.z);
    if (finite && volume > 1e-12 * box) return;
    const std::string size = finite && volume > 0 ? " and edges of " + numberText(edges) : "";
    throw Error(ErrorCode::kInput, "worldFromIndex",
                "voxels of volume " + numberText(volume) + size,
                "a finite transform that can be inverted");
}

WorldBox worldBox(const IndexBox& box, const glm::dmat4& worldFromIndex) {
    const IndexBox full = box.empty() ? IndexBox{glm::ivec3(0), glm::ivec3(0)} : box;
    WorldBox world;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 place(worldFromIndex * glm::dvec4(cornerOf(full, corner), 1));
        world.min = corner == 0 ? place : glm::min(world.min, place);
        world.max = corner == 0 ? place : glm::max(world.max, place);
    }
    return world;
}

}  // namespace deltasplat
