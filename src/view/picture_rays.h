// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/vec3.hpp>
#include <vector>

#include "deltasplat/view/camera.h"

namespace deltasplat {

/// Directions in which the pixels of a picture are seen from an eye, made row by row and column by
/// column: rays are sums and products of what their row and their column have.
class PictureRays {
  public:
    /// @param fromWorld  linear: what directions are wanted in
    PictureRays(const Camera& camera, const glm::dmat3& fromWorld);

    /// Returns the direction, not of length 1, of a pixel's middle.
    glm::dvec3 at(int x, int y) const {
        return rows_[std::size_t(y)].share * columns_[std::size_t(x)] + rows_[std::size_t(y)].rest;
    }

    /// By how much directions change from this pixel to the next one, or from the one before.
    glm::dvec3 alongX(int x, int y) const {
        const int next = std::min(x + 1, int(columns_.size()) - 1);
        return next == 0 ? glm::dvec3(0) : at(next, y) - at(next - 1, y);
    }
    glm::dvec3 alongY(int x, int y) const {
        const int next = std::min(y + 1, int(rows_.size()) - 1);
        return next == 0 ? glm::dvec3(0) : at(x, next) - at(x, next - 1);
    }

  private:
    struct Row {
        double share;
        glm::dvec3 rest;
    };

    std::vector<glm::dvec3> columns_;
    std::vector<Row> rows_;
};

}  // namespace deltasplat
