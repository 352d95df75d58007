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

/// Directions from an eye through a picture's pixels, from an entry per row and one per column.
class PictureRays {
  public:
    /// @param fromWorld  linear map to the space of the directions
    PictureRays(const Camera& camera, const glm::dmat3& fromWorld);

    /// Returns the direction through a pixel's middle. Its length is not 1.
    glm::dvec3 at(int x, int y) const {
        const Row& row = rows_[std::size_t(y)];
        return row.share * columns_[std::size_t(x)].ray + row.rest;
    }

    /// Change of the direction per pixel to the right, or down: the derivative at the pixel's
    /// middle, so that both sides get the same.
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

/// Extent of a box of voxels in a picture.
struct SeenBox {
    PixelBox part;         ///< pixels that may show the box
    glm::dvec2 size{0.0};  ///< in picture pixels; infinite if the eye is near
};

/// Returns the extent of a box whose voxels reach `reach` voxels beyond it.
SeenBox seenBox(const IndexBox& box, const glm::dmat4& worldFromIndex, const Camera& camera,
                double reach);

}  // namespace deltasplat
