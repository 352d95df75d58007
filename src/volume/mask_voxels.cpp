// SPDX-License-Identifier: Apache-2.0
#include "volume/mask_voxels.h"

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "base/affine.h"
#include "volume/cut_region.h"

namespace deltasplat {
namespace {

// Beyond all indices that volumes have.
constexpr double kFar = 1 << 30;

// Half way between two, rounding decides nothing: it is the latter.
int nearestIndex(double place) {
    return int(std::floor(std::clamp(place, -kFar, kFar) + 0.5 + kCutRounding));
}

// How many whole voxels each of a volume's lies from the one of the mask at the same place, as
// exactly as files state places.
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

// The box of a mask, and a voxel around it, in the indices of a volume.
IndexBox reachOf(const IndexBox& maskBox, const glm::dmat4& volumeFromMask) {
    if (maskBox.empty()) return {};
    const WorldBox reach =
        worldBox({maskBox.min - glm::ivec3(1), maskBox.max + glm::ivec3(1)}, volumeFromMask);
    const glm::dvec3 most(kFar);
    return {glm::ivec3(glm::clamp(glm::floor(reach.min), -most, most)),
            glm::ivec3(glm::clamp(glm::ceil(reach.max), -most, most))};
}

}  // namespace

MaskVoxels::MaskVoxels(const Volume& mask, const Volume& volume)
    : tree_(mask.codes->tree()),
      maskFromVolume_(glm::inverse(mask.worldFromIndex) * volume.worldFromIndex),
      shift_(wholeShift(maskFromVolume_, volume.box)),
      box_(reachOf(mask.box, glm::inverse(volume.worldFromIndex) * mask.worldFromIndex)) {
    for (int code = 0; code < kCodeCount; ++code)
        keeps_[std::size_t(code)] = mask.codeBook.valueOf(Code(code)) != 0;
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
