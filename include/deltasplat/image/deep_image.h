// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

namespace deltasplat {

/// A piece of a pixel's line of sight by itself: a volume sample of "Interpreting OpenEXR Deep
/// Pixels". The halves of a cut piece absorb in proportion to their lengths.
struct DeepSample {
    glm::vec4 rgba{0.0f};  ///< scene-linear, premultiplied; may have colour without alpha
    float z = 0;           ///< depth of its front, in world units, >= 0
    float zBack = 0;       ///< depth of its back, at least z
};

/// A row of pixels with any number of samples each.
struct DeepRow {
    std::vector<std::size_t> begins{0};  ///< [width + 1]: the first of each pixel's samples
    std::vector<DeepSample> samples;     ///< pixel by pixel, front to back
};

/// A picture with depth: rows top to bottom. Samples of a pixel are sorted and do not overlap
/// (tidy); put over each other they give the flat picture's pixel.
struct DeepImage {
    glm::ivec2 size{0};
    std::vector<DeepRow> rows;  ///< [size.y]

    std::span<const DeepSample> pixel(int x, int y) const {
        const DeepRow& row = rows[std::size_t(y)];
        const std::size_t begin = row.begins[std::size_t(x)];
        return {row.samples.data() + begin, row.begins[std::size_t(x) + 1] - begin};
    }
    std::size_t samples() const {
        std::size_t sum = 0;
        for (const DeepRow& row : rows) sum += row.samples.size();
        return sum;
    }
};

}  // namespace deltasplat
