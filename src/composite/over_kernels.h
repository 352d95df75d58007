// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace deltasplat {

/// What compositing one slice multiplies with.
struct OverWeights {
    OverWeights(glm::vec2 fraction, const glm::vec4& unitScale, bool order)
        : corner{(1 - fraction.x) * (1 - fraction.y), fraction.x * (1 - fraction.y),
                 (1 - fraction.x) * fraction.y, fraction.x * fraction.y},
          scale(unitScale),
          frontToBack(order) {}

    float corner[4];  ///< bilinear weights of (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)
    glm::vec4 scale;  ///< sheet units to RGBA
    bool frontToBack;
};

/// A run of pixels along one row.
struct OverSpan {
    const std::int32_t* row;      ///< the sheet at the run's first pixel
    const std::int32_t* nextRow;  ///< the sheet one row further
    float* layer;                 ///< the layer at the run's first pixel
    std::size_t pixels;
};

/// Reads the sheet bilinearly and composites it with the layer, for every span. Multiplications and
/// additions are separate and per pixel, so that every SIMD level gives the same bits.
void overSpans(const std::vector<OverSpan>& spans, const OverWeights& weights);

/// Puts premultiplied `layer` behind `front`: front += (1 - front.a) * layer, for a row of RGBA
/// pixels.
void mergeBehind(float* front, const float* layer, std::size_t pixels);

}  // namespace deltasplat
