// SPDX-License-Identifier: Apache-2.0
#include "composite/layer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace deltasplat {
SheetShift shiftOf(const SheetLayout& layout, glm::dvec2 shiftPerSlice, int slice) {
    const double slices = double(slice) - double(layout.firstSlice);
    const glm::dvec2 sheetOrigin =
        shiftPerSlice * slices * double(layout.resolution) - double(layout.marginPixels);
    const glm::dvec2 whole = glm::floor(-sheetOrigin);
    return {glm::ivec2(whole) - glm::ivec2(0, layout.originRow), -sheetOrigin - whole};
}

PlaneBox reachOf(const SheetLayout& layout, glm::dvec2 shiftPerSlice, int firstSlice,
                 int sliceCount) {
    const glm::ivec2 first = -shiftOf(layout, shiftPerSlice, firstSlice).offset;
    const glm::ivec2 last = -shiftOf(layout, shiftPerSlice, firstSlice + sliceCount - 1).offset;
    return {glm::min(first, last), glm::max(first, last) + layout.sizePixels};
}

void Layer::reset(const PlaneBox& planeBox) {
    for (std::size_t row = 0; row < spans.size(); ++row) {
        if (spans[row].x >= spans[row].y) continue;
        float* first = &values[channels * (row * box.size().x + spans[row].x)];
        std::fill_n(first, channels * (spans[row].y - spans[row].x), 0.0f);
    }
    box = planeBox;
    values.resize(std::size_t(channels) * box.size().x * box.size().y);
    spans.assign(std::size_t(box.size().y), kNothing);
}

void mergeRowBehind(Layer& front, const Layer& layer, int y) {
    if (y < layer.box.min.y || y >= layer.box.max.y) return;
    const glm::ivec2 span = layer.spans[std::size_t(y - layer.box.min.y)];
    if (span.x >= span.y) return;
    const glm::ivec2 first(layer.box.min.x + span.x, y);
    front.extend(y, first.x, first.x + span.y - span.x);
    mergeBehind(front.pixel(first), layer.pixel(first), std::size_t(span.y - span.x),
                front.channels);
}

}  // namespace deltasplat
