// SPDX-License-Identifier: Apache-2.0
#include "volume/cut_region.h"

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/affine.h"

namespace deltasplat {

IndexPlane indexPlane(const ClipPlane& plane, const glm::dmat4& worldFromIndex) {
    // Scaled so that squares cannot overflow, however long the normal is.
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

// Distances are monotonic in each index, so two corners decide for all voxels.
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
    // Inside of the mask's box only its voxels decide.
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

namespace {

// Beyond the indices of all volumes.
constexpr double kFar = 1 << 30;

// Takes the latter index half way between two, so that rounding errors decide nothing.
int nearestIndex(double place) {
    return int(std::floor(std::clamp(place, -kFar, kFar) + 0.5 + kCutRounding));
}

// Returns the whole shift from volume to mask indices, if places match as exactly as files state.
std::optional<openvdb::Coord> wholeShift(const glm::dmat4& maskFromVolume, const IndexBox& box) {
    constexpr double kNear = 1e-3;
    const glm::dvec3 first = box.min;
    const glm::dvec3 shift = glm::round(glm::dvec3(maskFromVolume * glm::dvec4(first, 1)) - first);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at = cornerOf(box, corner);
        const glm::dvec3 off =
            glm::abs(glm::dvec3(maskFromVolume * glm::dvec4(at, 1)) - at - shift);
        if (!(std::max({off.x, off.y, off.z}) < kNear)) return {};
    }
    if (!(std::max({std::abs(shift.x), std::abs(shift.y), std::abs(shift.z)}) < kFar)) return {};
    return openvdb::Coord(int(shift.x), int(shift.y), int(shift.z));
}

// Returns the mask's box, grown by one voxel, in the volume's indices.
IndexBox reachOf(const IndexBox& maskBox, const glm::dmat4& volumeFromMask) {
    if (maskBox.empty()) return {};
    const WorldBox reach =
        worldBox({maskBox.min - glm::ivec3(1), maskBox.max + glm::ivec3(1)}, volumeFromMask);
    const glm::dvec3 most(kFar);
    return {glm::ivec3(glm::clamp(glm::floor(reach.min), -most, most)),
            glm::ivec3(glm::clamp(glm::ceil(reach.max), -most, most))};
}

}  // namespace

MaskVoxels::MaskVoxels(const Volume& mask, const VolumeData& volume)
    : tree_(mask.codes()->tree()),
      maskFromVolume_(glm::inverse(mask.worldFromIndex()) * volume.worldFromIndex),
      shift_(wholeShift(maskFromVolume_, volume.box)),
      box_(reachOf(mask.box(), glm::inverse(volume.worldFromIndex) * mask.worldFromIndex())) {
    for (int code = 0; code < kCodeCount; ++code)
        keeps_[std::size_t(code)] = mask.codeBook().valueOf(Code(code)) != 0;
}

openvdb::Coord MaskVoxels::placeOf(const openvdb::Coord& voxel) const {
    if (shift_) return voxel + *shift_;
    const glm::dvec4 place =
        maskFromVolume_ * glm::dvec4(double(voxel.x()), double(voxel.y()), double(voxel.z()), 1);
    return {nearestIndex(place.x), nearestIndex(place.y), nearestIndex(place.z)};
}

void MaskVoxels::keepIn(const openvdb::Coord& origin, CodeTree::Leaf::NodeMaskType& voxels) const {
    openvdb::tree::ValueAccessor<const CodeTree::Tree, false> accessor(tree_);
    for (auto on = voxels.beginOn(); on; ++on) {
        Code code = 0;
        const openvdb::Coord voxel = origin + CodeTree::Leaf::offsetToLocalCoord(on.pos());
        if (!accessor.probeValue(placeOf(voxel), code) || !keeps_[code]) voxels.setOff(on.pos());
    }
}

}  // namespace deltasplat
