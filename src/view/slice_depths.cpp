// SPDX-License-Identifier: Apache-2.0
#include "view/slice_depths.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace deltasplat {

SliceDepths::SliceDepths(const Camera& camera, const glm::dmat4& worldFromSlices)
    : camera_(camera), origin_(worldFromSlices[3]) {
    const glm::dmat3 inverse = glm::inverse(glm::dmat3(worldFromSlices));
    slicesPerWorld_ = {inverse[0][0], inverse[1][0], inverse[2][0]};
    if (camera.projection != Projection::kOrtho) rays_.emplace(camera, glm::dmat3(1));
}

DepthLine SliceDepths::lineAt(int x, int y) const {
    glm::dvec3 ray = camera_.direction;
    glm::dvec3 start = camera_.eyeWorld();
    if (rays_) {
        ray = rays_->at(x, y);
    } else {
        start += camera_.worldFromPixel({x + 0.5, y + 0.5}) - camera_.targetWorld;
    }
    const bool isPanorama = camera_.projection == Projection::kLatlong;
    const double depth = isPanorama ? glm::length(ray) : glm::dot(ray, camera_.direction);
    DepthLine line;
    line.perSlice = depth / glm::dot(slicesPerWorld_, ray);
    line.first = glm::dot(slicesPerWorld_, origin_ - start) * line.perSlice;
    return line;
}

}  // namespace deltasplat
