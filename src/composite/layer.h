// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <memory_resource>
#include <vector>

#include "composite/over_kernels.h"
#include "uncleared_vector.h"
#include "view/base_plane.h"

namespace deltasplat {

/// The composited light of one slab on the base plane: float `[row][width][channels]`, rows along
/// u as those of sheets; premultiplied RGBA, or opacity alone where all that is seen has one
/// colour.
struct Layer {
    PlaneBox box;
    int channels;
    pmr::UnclearedVector<float> values;

    /// [rows]: columns [x, y) of the box, outside of which a row is zero.
    std::vector<glm::ivec2> spans;

    /// @param memory  for the values
    explicit Layer(const PlaneBox& planeBox, int channelCount = 4,
                   std::pmr::memory_resource& memory = *std::pmr::get_default_resource())
        : box(planeBox), channels(channelCount), values(&memory) {
        setBox(planeBox);
        clearRows(box.min.y, box.max.y);
    }

    /// Makes an empty layer of the same number of channels, in the memory that this one has.
    void reset(const PlaneBox& planeBox);
    /// Becomes a layer of a box, whose rows have no values before clearRows().
    void setBox(const PlaneBox& planeBox);
    /// Makes rows [first, last) zero.
    void clearRows(int first, int last);
    /// Makes all zero, on all threads.
    void clear();
    /// Takes rows [first, last), all zero here, from a layer of the same box and channels.
    void takeRows(const Layer& other, int first, int last);
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

/// Bytes that the values of a layer take.
inline double layerBytes(const PlaneBox& box, int channels) {
    const glm::dvec2 size = box.size();
    return sizeof(float) * channels * size.x * size.y;
}

/// A row of a layer.
struct LayerRow {
    const float* values;  ///< [width][channels]
    int firstColumn;      ///< of the base plane
    glm::ivec2 span;      ///< columns [x, y) outside of which it is zero
};

/// Puts row `y` behind a layer that covers it.
void mergeRowBehind(Layer& front, const LayerRow& row, int y);
/// Puts row `y` of a layer, if it has it, behind another layer that covers it.
void mergeRowBehind(Layer& front, const Layer& layer, int y);

}  // namespace deltasplat
