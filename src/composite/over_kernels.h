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
    /// @param fraction  how far base plane pixels lie behind sheet pixels, 0..1 along each axis
    /// @param scale     sheet units to RGBA; of one channel only the last is used
    OverWeights(glm::vec2 fraction, const glm::vec4& scale, int channelCount, bool order)
        : thisRow((1 - fraction.y) * scale),
          nextRow(fraction.y * scale),
          thisColumn(1 - fraction.x),
          nextColumn(fraction.x),
          channels(channelCount),
          frontToBack(order) {}

    /// Whether sheet pixels fall on the layer's.
    bool straight() const { return nextColumn == 0 && nextRow == glm::vec4(0); }

    glm::vec4 thisRow;
    glm::vec4 nextRow;
    float thisColumn;
    float nextColumn;
    int channels;  ///< of sheet and layer: 4 (RGBA) or 1 (opacity)
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

/// Puts premultiplied `layer` behind `front`: front += (1 - front.a) * layer, for a row of pixels.
void mergeBehind(float* front, const float* layer, std::size_t pixels, int channels);

}  // namespace deltasplat
