// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "deltasplat/optics/class_table.h"

namespace deltasplat {

/// Factors for compositing one slice.
struct OverWeights {
    /// @param fraction  distance of base plane pixels behind sheet pixels, 0..1 along each axis
    /// @param scales    sheet units to RGBA, per plane; a single channel uses the last
    OverWeights(glm::vec2 fraction, std::span<const glm::vec4> scales, int channelCount)
        : straight(fraction == glm::vec2(0)),
          thisColumn(1 - fraction.x),
          nextColumn(fraction.x),
          channels(channelCount) {
        for (std::size_t p = 0; p < scales.size(); ++p) {
            thisRow[p] = (1 - fraction.y) * scales[p];
            nextRow[p] = fraction.y * scales[p];
        }
    }

    bool straight;  ///< whether sheet pixels coincide with the layer's
    std::array<glm::vec4, ClassTable::kMaxPlanes> thisRow;  ///< per plane
    std::array<glm::vec4, ClassTable::kMaxPlanes> nextRow;
    float thisColumn;
    float nextColumn;
    int channels;  ///< of sheets and layer: 4 (RGBA) or 1 (opacity)
};

/// The sheets of a slice, one per plane of colours.
struct OverSheets {
    std::array<const std::int32_t*, ClassTable::kMaxPlanes> pixels;  ///< `[row][pitch]`
    std::size_t pitch;  ///< integers from one row to the next
};

/// A run of pixels along one row.
struct OverSpan {
    std::size_t place;  ///< of the sheets' first pixel, in integers
    float* layer;       ///< the layer at the run's first pixel
    std::uint32_t pixels;
    std::uint32_t planes;  ///< bit p: plane p may be other than zero; not 0
};

/// Reads the sum of the sheets bilinearly and puts it behind the layer, for every span.
/// Multiplications and additions are separate and per pixel, and planes are added in order, so
/// every SIMD level gives the same bits, whether planes of zeros are read or not.
void overSpans(const std::vector<OverSpan>& spans, const OverSheets& sheets,
               const OverWeights& weights);

/// Puts premultiplied `layer` behind `front`: front += (1 - front.a) * layer, for a row of pixels.
void mergeBehind(float* front, const float* layer, std::size_t pixels, int channels);

}  // namespace deltasplat
