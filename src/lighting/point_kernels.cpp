// SPDX-License-Identifier: Apache-2.0
#include "lighting/point_kernels.h"

#include <algorithm>
#include <cmath>

#include "lighting/sweep_kernels.h"

namespace deltasplat {

void addToNodes(const NodesOnBlock& rows, const NodesOnBlock& columns, const float* own,
                float share, float* out, std::size_t pitch) {
    // Rows of voxels at the columns of nodes, with zeros before the first and after the last.
    std::array<std::array<float, NodesOnBlock::kMost>, 10> seen;
    seen.front().fill(0);
    seen.back().fill(0);
    for (std::size_t u = 0; u < 8; ++u) {
        std::array<float, 10> row{};
        for (std::size_t v = 0; v < 8; ++v) row[v + 1] = share * own[8 * u + v];
        for (std::size_t n = 0; n < columns.count; ++n) {
            const float* before = &row[columns.before[n]];
            seen[u + 1][n] = before[0] + columns.share[n] * (before[1] - before[0]);
        }
    }
    for (std::size_t k = 0; k < rows.count; ++k, out += pitch) {
        const float* before = seen[rows.before[k]].data();
        const float* after = seen[rows.before[k] + 1].data();
        for (std::size_t n = 0; n < columns.count; ++n)
            out[n] += before[n] + rows.share[k] * (after[n] - before[n]);
    }
}

void readBetweenNodes(const VoxelsBetweenNodes& rows, const VoxelsBetweenNodes& columns,
                      const float* plane, std::size_t pitch, std::uint16_t* out,
                      glm::ivec2 stride) {
    for (int u = rows.begin; u < rows.end; ++u) {
        const auto i = std::size_t(u);
        const float* above = plane + rows.before[i] * std::ptrdiff_t(pitch);
        for (int v = columns.begin; v < columns.end; ++v) {
            const auto j = std::size_t(v);
            const float* first = above + columns.before[j];
            const float* second = first + pitch;
            const float inAbove = first[0] + columns.share[j] * (first[1] - first[0]);
            const float inBelow = second[0] + columns.share[j] * (second[1] - second[0]);
            const float sum = inAbove + rows.share[i] * (inBelow - inAbove);
            const glm::vec3 way = rows.way[i] + columns.way[j];
            const float length = std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
            const float code = std::sqrt(sum * length) * kDepthSteps + 0.5f;
            out[u * stride.x + v * stride.y] = std::uint16_t(std::min(code, 65535.0f));
        }
    }
}

}  // namespace deltasplat
