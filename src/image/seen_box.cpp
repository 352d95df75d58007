// SPDX-License-Identifier: Apache-2.0
#include "image/seen_box.h"

#include <algorithm>
#include <vector>

#include "base/parallel.h"

namespace deltasplat {
namespace {

template <typename IsSeen>
PixelBox boxOfPixels(const PixelBox& within, const IsSeen& isSeen) {
    std::vector<glm::ivec2> spans(std::size_t(within.size().y), glm::ivec2(0));
    parallelFor(spans.size(), [&](std::size_t row) {
        const int y = within.min.y + int(row);
        int first = within.min.x;
        while (first < within.max.x && !isSeen(first, y)) ++first;
        int last = within.max.x;
        while (last > first && !isSeen(last - 1, y)) --last;
        spans[row] = {first, last};
    });
    return boxOfRows(within.min.y, spans);
}

}  // namespace

PixelBox boxOfRows(int first, std::span<const glm::ivec2> spans) {
    PixelBox box;
    for (std::size_t i = 0; i < spans.size(); ++i) {
        if (spans[i].x >= spans[i].y) continue;
        const int y = first + int(i);
        const PixelBox row{{spans[i].x, y}, {spans[i].y, y + 1}};
        box = box.empty() ? row
                          : PixelBox{{std::min(box.min.x, row.min.x), box.min.y},
                                     {std::max(box.max.x, row.max.x), row.max.y}};
    }
    return box;
}

PixelBox seenBox(const Image& image, const PixelBox& within,
                 std::span<const ImageChannel> channels) {
    return boxOfPixels(within, [&](int x, int y) {
        const float* rgba = image.pixel(x, y);
        const std::size_t i = std::size_t(rgba - image.rgba.data()) / 4;
        return std::any_of(rgba, rgba + 4, [](float value) { return value != 0; }) ||
               std::any_of(channels.begin(), channels.end(), [&](const ImageChannel& channel) {
                   return channel.values[i] != channel.nothing;
               });
    });
}

PixelBox seenBox(const DeepImage& image, const PixelBox& within) {
    return boxOfPixels(within, [&](int x, int y) { return !image.pixel(x, y).empty(); });
}

}  // namespace deltasplat
