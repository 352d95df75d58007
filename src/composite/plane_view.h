// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "deltasplat/view/factorization.h"
#include "splat/sheet.h"

namespace deltasplat {

/// A factorization in the sheets' axes: they run along v.
struct PlaneView {
    explicit PlaneView(const Factorization& view);

    bool frontToBack;
    glm::dvec2 shiftPerSlice;
    glm::dmat3 planeFromPixel;
};

/// Maps picture positions to base plane pixels: r a voxel, counted from the layout's first voxel
/// and slice.
glm::dmat3 planeFromPixel(const PlaneView& view, const SheetLayout& layout);

}  // namespace deltasplat
