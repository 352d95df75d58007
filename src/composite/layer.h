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
/// colour. While it is made, a row has values in its span alone.
struct Layer {
    PlaneBox box;
    int channels;
    pmr::UnclearedVector<float> values;

    /// [rows]: columns [x, y) of the box, outside of which a finished row is zero.
    std::vector<glm::ivec2> spans;

    /// A finished layer, all zero.
    /// @param memory  for the values
    explicit Layer(const PlaneBox& planeBox, int channelCount = 4,
                   std::pmr::memory_resource& memory = *std::pmr::get_default_resource())
        : box(planeBox), channels(channelCount), values(&memory) {
        setBox(planeBox);
        for (int y = box.min.y; y < box.max.y; ++y) clearRest(y);
    }

    /// Becomes a layer of a box, with empty spans, in the memory that it has.
    void setBox(const PlaneBox& planeBox);
    /// Says that columns [first, last) of a row of the base plane may not be zero, and makes zero
    /// what comes to its span by that.
    void extend(int y, int first, int last) {
        first -= box.min.x;
        last -= box.min.x;
        const glm::ivec2 span = spans[std::size_t(y - box.min.y)];
        if (first < span.x || last > span.y) widen(y, {first, last});
    }
    /// Makes zero what lies outside of a row's span.
    void clearRest(int y);
    /// The same of all rows, on all threads.
    void clearRest();
    float* pixel(glm::ivec2 b) {
        const glm::ivec2 p = b - box.min;
        return &values[channels * (std::size_t(p.y) * box.size().x + p.x)];
    }
    const float* pixel(glm::ivec2 b) const { return const_cast<Layer*>(this)->pixel(b); }

  private:
    static constexpr glm::ivec2 kNothing{std::numeric_limits<int>::max(), 0};
    void widen(int y, glm::ivec2 columns);
    void fillZero(int y, int first, int last);
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
