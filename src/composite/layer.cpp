// SPDX-License-Identifier: Apache-2.0
#include "composite/layer.h"

#include <algorithm>

#include "parallel.h"

namespace deltasplat {

void Layer::reset(const PlaneBox& planeBox) {
    for (std::size_t row = 0; row < spans.size(); ++row) {
        if (spans[row].x >= spans[row].y) continue;
        float* first = &values[channels * (row * box.size().x + spans[row].x)];
        std::fill_n(first, channels * (spans[row].y - spans[row].x), 0.0f);
    }
    const std::size_t known = values.size();
    setBox(planeBox);
    if (values.size() > known)
        std::fill(values.begin() + std::ptrdiff_t(known), values.end(), 0.0f);
}

void Layer::setBox(const PlaneBox& planeBox) {
    box = planeBox;
    values.resize(std::size_t(channels) * box.size().x * box.size().y);
    spans.assign(std::size_t(box.size().y), kNothing);
}

void Layer::clearRows(int first, int last) {
    const std::size_t width = std::size_t(channels) * std::size_t(box.size().x);
    std::fill_n(values.data() + width * std::size_t(first - box.min.y),
                width * std::size_t(last - first), 0.0f);
}

void Layer::clear() {
    parallelForChunks(std::size_t(box.size().y), [&](std::size_t begin, std::size_t end) {
        clearRows(box.min.y + int(begin), box.min.y + int(end));
    });
}

void Layer::takeRows(const Layer& other, int first, int last) {
    for (int y = first; y < last; ++y) {
        const auto row = std::size_t(y - box.min.y);
        const glm::ivec2 span = other.spans[row];
        spans[row] = span;
        if (span.x >= span.y) continue;
        const std::size_t begin =
            std::size_t(channels) * (row * std::size_t(box.size().x) + std::size_t(span.x));
        const std::size_t count = std::size_t(channels) * std::size_t(span.y - span.x);
        std::copy_n(&other.values[begin], count, &values[begin]);
    }
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
