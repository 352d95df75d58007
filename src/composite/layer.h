// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <limits>
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

/// The composited light of one slab on the base plane: float `[row][width][channels]`, rows along
/// u as those of sheets; premultiplied RGBA, or opacity alone where all that is seen has one
/// colour.
struct Layer {
    PlaneBox box;
    int channels;
    std::vector<float> values;

    /// [rows]: columns [x, y) of the box, outside of which a row is zero.
    std::vector<glm::ivec2> spans;

    explicit Layer(const PlaneBox& planeBox, int channelCount = 4)
        : box(planeBox),
          channels(channelCount),
          values(std::size_t(channels) * box.size().x * box.size().y),
          spans(std::size_t(box.size().y), kNothing) {}

    /// Makes an empty layer of the same number of channels, in the memory that this one has.
    void reset(const PlaneBox& planeBox);
    /// Says that columns [first, last) of a row of the base plane may not be zero.
    void extend(int y, int first, int last) {
        glm::ivec2& span = spans[std::size_t(y - box.min.y)];
        span = {std::min(span.x, first - box.min.x), std::max(span.y, last - box.min.x)};
    }
    float* pixel(glm::ivec2 b) {
        const glm::ivec2 p = b - box.min;
        return &values[channels * (std::size_t(p.y) * box.size().x + p.x)];
    }
    const float* pixel(glm::ivec2 b) const { return const_cast<Layer*>(this)->pixel(b); }

  private:
    static constexpr glm::ivec2 kNothing{std::numeric_limits<int>::max(), 0};
};

/// Where one slice's sheet lies on the base plane: base pixel b reads the sheet at b + offset +
/// fraction.
struct SheetShift {
    glm::ivec2 offset{0};
    glm::dvec2 fraction{0.0};  ///< 0 <= fraction < 1
};

/// Returns where slice `slice` lies: shifted by shiftPerSlice voxels (v, u) for each slice since
/// the layout's first.
SheetShift shiftOf(const SheetLayout& layout, glm::dvec2 shiftPerSlice, int slice);

/// Returns the base plane pixels that any of `sliceCount` slices from `firstSlice` on can reach.
PlaneBox reachOf(const SheetLayout& layout, glm::dvec2 shiftPerSlice, int firstSlice,
                 int sliceCount);

/// Puts row `y` of a layer, if it has it, behind another layer that covers it.
void mergeRowBehind(Layer& front, const Layer& layer, int y);

}  // namespace deltasplat
