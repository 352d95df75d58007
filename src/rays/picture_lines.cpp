// SPDX-License-Identifier: Apache-2.0
#include "rays/picture_lines.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "deltasplat/view/factorization.h"
#include "view/seen_box.h"

namespace deltasplat {
namespace {

// What values between voxels reach.
constexpr double kReach = 1;

Camera refined(Camera camera, int perSide) {
    camera.sizePixels *= perSide;
    return camera;
}

double pixelsPerVoxel(const Volume& volume, const Camera& camera) {
    if (camera.projection == Projection::kOrtho)
        return factorize(camera, volume.worldFromIndex, 1).pixelsPerVoxel;
    return factorizeRegions(camera, volume.box, volume.worldFromIndex, 1).front().pixelsPerVoxel;
}

}  // namespace

int linesPerSide(const Volume& volume, const Camera& camera) {
    const double pixels = pixelsPerVoxel(volume, camera);
    const glm::dvec2 size(camera.sizePixels);
    // From an eye each row and column is held.
    const double mostAcross = camera.projection == Projection::kOrtho ? 0x1p30 : 0x1p18;
    const double most =
        std::max(std::floor(mostAcross / std::max(size.x, size.y)), double(kLeastPerSide));
    // Less than a tenth of a voxel too few does not matter.
    const double wanted = pixels > 0 ? std::clamp(std::ceil(1 / pixels - 0.1), 1.0, most) : most;
    if (wanted <= kLeastPerSide) return int(wanted);
    const SeenBox seen = seenBox(volume.box, volume.worldFromIndex, camera, kReach);
    const double shown = std::min(seen.size.x, size.x) * std::min(seen.size.y, size.y);
    const double affordable = std::sqrt(kMostLines / std::max(shown, 0x1p-60));
    return int(std::min(wanted, std::max(std::floor(affordable), double(kLeastPerSide))));
}

PictureLines::PictureLines(const Volume& volume, const Camera& camera, int perSide)
    : camera_(camera), perSide_(perSide), box_(volume.box), linear_(volume.worldFromIndex) {
    const glm::dmat3 fromWorld = glm::inverse(linear_);
    const Camera fine = refined(camera, perSide);
    seen_ = seenBox(volume.box, volume.worldFromIndex, fine, kReach).part;
    const glm::dvec3 first(volume.worldFromIndex * glm::dvec4(volume.box.min, 1));
    if (camera.projection != Projection::kOrtho) {
        rays_.emplace(fine, fromWorld);
        origin_ = fromWorld * (camera.eyeWorld() - first);
        return;
    }
    origin_ = fromWorld * (fine.worldFromPixel({0.5, 0.5}) - first);
    alongX_ = fine.pixelWorld() * (fromWorld * camera.right);
    alongY_ = -fine.pixelHeightWorld() * (fromWorld * camera.up);
    first_ = lineOf(origin_, fromWorld * camera.direction);
}

PictureLine PictureLines::at(int x, int y) const {
    if (first_) {
        PictureLine line = *first_;
        line.ray.moveTo(origin_ + double(x) * alongX_ + double(y) * alongY_);
        return line;
    }
    PictureLine line = lineOf(origin_, rays_->at(x, y));
    line.ray.beginAt(camera_.nearWorld / line.depthWorld);
    return line;
}

PictureLine PictureLines::lineOf(const glm::dvec3& through, const glm::dvec3& direction) const {
    const SightRay ray(box_, through, direction);
    const glm::dvec3 perSlice = linear_ * (direction / std::abs(direction[ray.axes.order[0]]));
    const double length = glm::length(perSlice);
    const bool isFlat = camera_.projection != Projection::kLatlong;
    return {ray, length, isFlat ? glm::dot(perSlice, camera_.direction) : length,
            rays_ ? 0 : camera_.targetDistanceWorld};
}

}  // namespace deltasplat
