// SPDX-License-Identifier: Apache-2.0
#include "rays/picture_lines.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "deltasplat/view/factorization.h"

namespace deltasplat {
namespace {

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
    if (!(pixels > 0)) return kMostPerSide;
    // Less than a tenth of a voxel too few does not matter.
    return int(std::clamp(std::ceil(1 / pixels - 0.1), 1.0, double(kMostPerSide)));
}

PictureLines::PictureLines(const Volume& volume, const Camera& camera, int perSide)
    : camera_(camera), perSide_(perSide), box_(volume.box), linear_(volume.worldFromIndex) {
    const glm::dmat3 fromWorld = glm::inverse(linear_);
    const Camera fine = refined(camera, perSide);
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
