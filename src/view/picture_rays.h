// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "deltasplat/image/pixel_box.h"
#include "deltasplat/ingest/volume.h"
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
        const Row& row = rows_[std::size_t(y)];
        return row.share * columns_[std::size_t(x)].ray + row.rest;
    }

    /// By how much directions change for each pixel to the right, or down: how steeply in the
    /// pixel's middle, so that they are the same from left and right.
    glm::dvec3 alongX(int x, int y) const {
        return rows_[std::size_t(y)].share * columns_[std::size_t(x)].change;
    }
    glm::dvec3 alongY(int x, int y) const {
        const Row& row = rows_[std::size_t(y)];
        return row.changeOfShare * columns_[std::size_t(x)].ray + row.changeOfRest;
    }

  private:
    struct Column {
        glm::dvec3 ray;
        glm::dvec3 change;  // to the right
    };
    struct Row {
        double share;
        double changeOfShare;  // down
        glm::dvec3 rest;
        glm::dvec3 changeOfRest;
    };

    std::vector<Column> columns_;
    std::vector<Row> rows_;
};

/// How a picture shows a box of voxels.
struct SeenBox {
    PixelBox part;         ///< pixels that may show something of it
    glm::dvec2 size{0.0};  ///< of the box in the picture, in pixels; infinite if the eye is near
};

/// Returns what a picture may show of a box whose voxels reach `reach` voxels beyond it.
SeenBox seenBox(const IndexBox& box, const glm::dmat4& worldFromIndex, const Camera& camera,
                double reach);

}  // namespace deltasplat
