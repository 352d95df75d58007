// SPDX-License-Identifier: Apache-2.0
#include "cut/index_plane.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace deltasplat {

IndexPlane indexPlane(const ClipPlane& plane, const glm::dmat4& worldFromIndex) {
    // However long the normal is, no square of it overflows.
    const glm::dvec3 size = glm::abs(plane.normalWorld);
    const glm::dvec3 normal = plane.normalWorld / std::max({size.x, size.y, size.z});
    const auto along = [&](const glm::dvec4& step) { return glm::dot(normal, glm::dvec3(step)); };
    const glm::dvec3 slope(along(worldFromIndex[0]), along(worldFromIndex[1]),
                           along(worldFromIndex[2]));
    const glm::dvec3 widths = glm::abs(slope);
    const double extent = widths.x + widths.y + widths.z;
    const double offset = glm::dot(normal, glm::dvec3(worldFromIndex[3]) - plane.pointWorld);
    return {slope / extent, offset / extent};
}

}  // namespace deltasplat
