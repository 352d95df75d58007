// SPDX-License-Identifier: Apache-2.0
#include "composite/plane_view.h"

namespace deltasplat {

PlaneView::PlaneView(const Factorization& view)
    : frontToBack(view.frontToBack),
      shiftPerSlice(view.shiftPerSlice.y, view.shiftPerSlice.x),
      planeFromPixel(glm::dmat3(0, 1, 0, 1, 0, 0, 0, 0, 1) * view.baseFromPixel) {}

glm::dmat3 planeFromPixel(const PlaneView& view, const SheetLayout& layout) {
    const glm::dvec2 origin =
        glm::dvec2(layout.firstVoxel) + double(layout.firstSlice) * view.shiftPerSlice;
    glm::dmat3 relative = view.planeFromPixel;
    relative[2] -= glm::dvec3(origin, 0);
    const double r = layout.resolution;
    const double offset = layout.offsetPixels;
    return glm::dmat3(r, 0, 0, 0, r, 0, -offset, -offset, 1) * relative;
}

}  // namespace deltasplat
