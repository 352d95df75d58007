// SPDX-License-Identifier: Apache-2.0
#include "volume/cut_region.h"

#include <algorithm>
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

namespace {

Kept keptOfBox(const IndexBox& box, const IndexBox& voxels) {
    const IndexBox shared = sharedBox(box, voxels);
    if (shared.empty()) return Kept::kNone;
    return shared == voxels ? Kept::kAll : Kept::kSome;
}

bool keeps(const IndexPlane& plane, const glm::dvec3& posIndex) {
    return plane.distanceAt(posIndex) >= -kCutRounding;
}

// Distances are monotonic in each index, so that two corners tell of all voxels.
Kept keptOfPlane(const IndexPlane& plane, const IndexBox& voxels) {
    glm::dvec3 least, most;
    for (int axis = 0; axis < 3; ++axis) {
        const bool rises = plane.slope[axis] >= 0;
        least[axis] = rises ? voxels.min[axis] : voxels.max[axis];
        most[axis] = rises ? voxels.max[axis] : voxels.min[axis];
    }
    if (keeps(plane, least)) return Kept::kAll;
    return keeps(plane, most) ? Kept::kSome : Kept::kNone;
}

}  // namespace

IndexBox sharedBox(const IndexBox& a, const IndexBox& b) {
    return {glm::max(a.min, b.min), glm::min(a.max, b.max)};
}

Kept CutRegion::keptOf(const IndexBox& voxels) const {
    Kept kept = keptOfBox(box, voxels);
    for (const IndexPlane& plane : planes) kept = std::min(kept, keptOfPlane(plane, voxels));
    // What lies within its box only its voxels tell.
    if (mask && kept != Kept::kNone) kept = std::min(Kept::kSome, keptOfBox(mask->box(), voxels));
    return kept;
}

void CutRegion::keepIn(const openvdb::Coord& origin, CodeTree::Leaf::NodeMaskType& voxels) const {
    for (auto on = voxels.beginOn(); on; ++on) {
        const openvdb::Coord voxel = origin + CodeTree::Leaf::offsetToLocalCoord(on.pos());
        const glm::ivec3 index(voxel.x(), voxel.y(), voxel.z());
        const bool kept = keptOfBox(box, {index, index}) == Kept::kAll &&
                          std::all_of(planes.begin(), planes.end(),
                                      [&](const IndexPlane& plane) { return keeps(plane, index); });
        if (!kept) voxels.setOff(on.pos());
    }
    if (mask) mask->keepIn(origin, voxels);
}

}  // namespace deltasplat
