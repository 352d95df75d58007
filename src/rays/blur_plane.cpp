// SPDX-License-Identifier: Apache-2.0
// Based on: Lee Westover, "Footprint Evaluation for Volume Rendering", 1990; the sum over all
// slices is taken before the footprint's.
#include "rays/blur_plane.h"

#include "parallel.h"
#include "rays/ray_kernels.h"

namespace deltasplat {

RayPlane blurPlane(const RayPlane& plane, const Footprint& footprint, float scale) {
    std::vector<float> weights;
    for (const std::int32_t weight : footprint.weights)
        weights.push_back(float(weight / double(Footprint::kOne)));
    const int width = footprint.width;
    const int reach = footprint.reach();
    const int before = width - 1 - reach;  // pixels to the first that is read
    RayPlane blurred(plane.box);
    const glm::ivec2 size = plane.box.size();
    if (size.x < width || size.y < width) return blurred;
    const glm::ivec2 inner = size - width + 1;
    parallelForChunks(std::size_t(inner.y), [&](std::size_t begin, std::size_t end) {
        std::vector<const float*> rows(std::size_t(width), nullptr);
        for (std::size_t i = begin; i < end; ++i) {
            const int y = plane.box.min.y + before + int(i);
            for (int j = 0; j < width; ++j)
                rows[std::size_t(j)] = plane.row(y + reach - j) + width - 1;
            weighRow(rows.data(), weights.data(), width, scale, std::size_t(inner.x),
                     blurred.row(y) + before);
        }
    });
    return blurred;
}

}  // namespace deltasplat
