// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "composite/over_kernels.h"
#include "splat/sheet.h"

namespace deltasplat {

/// Pixels [min, max) of the base plane. Pixel (0, 0) lies at the sheet layout's first voxel on its
/// first slice, so that numbers stay small however far from the index origin a volume is.
struct PlaneBox {
    glm::ivec2 min{0};
    glm::ivec2 max{0};

    glm::ivec2 size() const { return max - min; }
    bool empty() const { return max.x <= min.x || max.y <= min.y; }
};

/// The composited premultiplied RGBA of one slab on the base plane: float `[row][width][4]`, rows
/// along v.
struct Layer {
    PlaneBox box;
    std::vector<float> rgba;

    explicit Layer(const PlaneBox& planeBox)
        : box(planeBox), rgba(std::size_t{4} * box.size().x * box.size().y) {}
    float* pixel(glm::ivec2 b) {
        const glm::ivec2 p = b - box.min;
        return &rgba[4 * (std::size_t(p.y) * box.size().x + p.x)];
    }
    const float* pixel(glm::ivec2 b) const { return const_cast<Layer*>(this)->pixel(b); }
};

/// Where one slice's sheet lies on the base plane: base pixel b reads the sheet at b + offset +
/// fraction.
struct SheetShift {
    glm::ivec2 offset{0};
    glm::dvec2 fraction{0.0};  ///< 0 <= fraction < 1
};

/// Returns where slice `slice` lies: shifted by shiftPerSlice voxels for each slice since the
/// layout's first.
SheetShift shiftOf(const SheetLayout& layout, glm::dvec2 shiftPerSlice, int slice);

/// Returns the base plane pixels that any of `sliceCount` slices from `firstSlice` on can reach.
PlaneBox reachOf(const SheetLayout& layout, glm::dvec2 shiftPerSlice, int firstSlice,
                 int sliceCount);

/// Composites one slice: its sheet, read bilinearly at the layer's pixels, goes behind what the
/// layer holds (front to back) or in front of it. Only what the sheet's occupied tiles reach is
/// touched.
/// @param scale  what one unit of the sheet is worth in each channel
void compositeSheet(const Sheet& sheet, const SheetShift& shift, const glm::vec4& scale,
                    bool frontToBack, Layer& layer);

/// Merges layers, given front to back, into one that covers them all. The order of the arithmetic
/// is fixed by the layers alone. Multi-threaded.
Layer mergeLayers(const std::vector<Layer>& frontToBack);

}  // namespace deltasplat
