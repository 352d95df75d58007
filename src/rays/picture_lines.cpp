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

// How wide a voxel is seen in the middle of the volume, over how long: 1 of a cube.
double narrowness(const Volume& volume, const Camera& camera) {
    const glm::dmat3 edges(volume.worldFromIndex);
    glm::dvec3 sight = camera.direction;
    if (camera.projection != Projection::kOrtho) {
        const glm::dvec3 middle = 0.5 * (glm::dvec3(volume.box.min) + glm::dvec3(volume.box.max));
        const glm::dvec3 away =
            glm::dvec3(volume.worldFromIndex * glm::dvec4(middle, 1)) - camera.eyeWorld();
        if (glm::length(away) > 0) sight = glm::normalize(away);
    }
    const glm::dmat3 across = edges - glm::outerProduct(sight, sight * edges);
    // The squares of how long and how wide, from their sum and that of their squares.
    const glm::dmat3 squares = across * glm::transpose(across);
    const double sum = squares[0][0] + squares[1][1] + squares[2][2];
    double ofSquares = 0;
    for (int column = 0; column < 3; ++column)
        ofSquares += glm::dot(squares[column], squares[column]);
    const double apart = std::sqrt(std::max(0.0, 2 * ofSquares - sum * sum));
    return sum > apart ? std::sqrt((sum - apart) / (sum + apart)) : 0;
}

double pixelsPerVoxel(const Volume& volume, const Camera& camera) {
    return camera.projection == Projection::kOrtho
               ? factorize(camera, volume.worldFromIndex, 1).pixelsPerVoxel
               : factorizeRegions(camera, volume.box, volume.worldFromIndex, 1)
                     .front()
                     .pixelsPerVoxel;
}

}  // namespace

LineCount countLines(const Volume& volume, const Camera& camera) {
    const double pixels = pixelsPerVoxel(volume, camera);
    const glm::dvec2 size(camera.sizePixels);
    // From an eye each row and column is held.
    const double mostAcross = camera.projection == Projection::kOrtho ? 0x1p30 : 0x1p18;
    const double most =
        std::max(std::floor(mostAcross / std::max(size.x, size.y)), double(kLeastPerSide));
    const double narrow = pixels * narrowness(volume, camera);
    // Less than a tenth of a voxel too few does not matter, nor a pixel half as large again as a
    // voxel is narrow.
    constexpr double kHardlyNarrow = 1.5;
    const auto linesOf = [most](double side) {
        return side > 0 ? std::max(std::ceil(1 / side - 0.1), 1.0) : most;
    };
    const double all = narrow * kHardlyNarrow >= 1 ? linesOf(pixels) : linesOf(narrow);
    const double wanted = std::min(all, most);
    if (wanted <= kLeastPerSide) return {int(wanted), all / wanted};
    const SeenBox seen = seenBox(volume.box, volume.worldFromIndex, camera, kReach);
    const double shown = std::min(seen.size.x, size.x) * std::min(seen.size.y, size.y);
    const double affordable = std::sqrt(kMostLines / std::max(shown, 0x1p-60));
    const double count = std::min(wanted, std::max(std::floor(affordable), double(kLeastPerSide)));
    return {int(count), all / count};
}

PictureLines::PictureLines(const Volume& volume, const Camera& camera, int perSide)
    : camera_(camera),
      perSide_(perSide),
      fine_(refined(camera, perSide)),
      world_(volume.worldFromIndex),
      box_(volume.box),
      seen_(seenOf(volume.box)),
      linear_(volume.worldFromIndex) {
    const glm::dmat3 fromWorld = glm::inverse(linear_);
    const glm::dvec3 first(volume.worldFromIndex * glm::dvec4(volume.box.min, 1));
    if (camera.projection != Projection::kOrtho) {
        rays_.emplace(fine_, fromWorld);
        origin_ = fromWorld * (camera.eyeWorld() - first);
        return;
    }
    origin_ = fromWorld * (fine_.worldFromPixel({0.5, 0.5}) - first);
    alongX_ = fine_.pixelWorld() * (fromWorld * camera.right);
    alongY_ = -fine_.pixelHeightWorld() * (fromWorld * camera.up);
    first_ = lineOf(origin_, fromWorld * camera.direction);
}

PixelBox PictureLines::seenOf(const IndexBox& box) const {
    return seenBox(box, world_, fine_, kReach).part;
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
