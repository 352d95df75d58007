// SPDX-License-Identifier: Apache-2.0
#include "composite/layer.h"

#include <algorithm>

#include "parallel.h"

namespace deltasplat {

void Layer::setBox(const PlaneBox& planeBox) {
    box = planeBox;
    values.resize(std::size_t(channels) * box.size().x * box.size().y);
    spans.assign(std::size_t(box.size().y), kNothing);
}

// Makes columns [first, last) of the box zero, in a row.
void Layer::fillZero(int y, int first, int last) {
    if (first >= last) return;
    std::fill_n(pixel({box.min.x + first, y}), std::size_t(channels) * (last - first), 0.0f);
}

void Layer::widen(int y, glm::ivec2 columns) {
    glm::ivec2& span = spans[std::size_t(y - box.min.y)];
    if (span.x >= span.y) {
        fillZero(y, columns.x, columns.y);
        span = columns;
    } else {
        fillZero(y, columns.x, span.x);
        fillZero(y, span.y, columns.y);
        span = {std::min(span.x, columns.x), std::max(span.y, columns.y)};
    }
}

void Layer::clearRest(int y) {
    glm::ivec2 span = spans[std::size_t(y - box.min.y)];
    if (span.x >= span.y) span = glm::ivec2(box.size().x);
    fillZero(y, 0, span.x);
    fillZero(y, span.y, box.size().x);
}

void Layer::clearRest() {
    parallelForChunks(std::size_t(box.size().y), [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) clearRest(box.min.y + int(row));
    });
}

void mergeRowBehind(Layer& front, const LayerRow& row, int y) {
    const glm::ivec2 span = row.span;
    if (span.x >= span.y) return;
    const glm::ivec2 first(row.firstColumn + span.x, y);
    front.extend(y, first.x, first.x + span.y - span.x);
    mergeBehind(front.pixel(first), row.values + front.channels * std::ptrdiff_t{span.x},
                std::size_t(span.y - span.x), front.channels);
}

void mergeRowBehind(Layer& front, const Layer& layer, int y) {
    if (y < layer.box.min.y || y >= layer.box.max.y) return;
    const auto row = std::size_t(y - layer.box.min.y);
    const std::size_t width = std::size_t(layer.channels) * std::size_t(layer.box.size().x);
    mergeRowBehind(front, {layer.values.data() + row * width, layer.box.min.x, layer.spans[row]},
                   y);
}

}  // namespace deltasplat
