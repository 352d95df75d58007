// SPDX-License-Identifier: Apache-2.0
#include "composite/layer.h"

#include <algorithm>

namespace deltasplat {

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
