// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

#include "composite/layer.h"
#include "composite/over_kernels.h"
#include "splat/sheet.h"

namespace deltasplat {

/// Composites sheets into layers. Holds what that takes, to be used for one slice after the other;
/// not thread-safe.
class Compositor {
  public:
    /// @param scale  what one unit of a sheet is worth in each channel
    Compositor(const glm::vec4& scale, bool frontToBack)
        : scale_(scale), frontToBack_(frontToBack) {}

    /// Composites one slice: its sheet, read bilinearly at the layer's pixels, goes behind what the
    /// layer holds (front to back) or in front of it. Only what the sheet's full rows reach is
    /// touched; of that, rows [firstRow, lastRow) of the base plane, which the layer has.
    void composite(const Sheet& sheet, const SheetShift& shift, int firstRow, int lastRow,
                   Layer& layer);

  private:
    void findSpans(const Sheet& sheet, const SheetShift& shift, int firstRow, int lastRow,
                   bool straight, Layer& layer);
    unsigned findRows(const Sheet& sheet, int tileRow);
    void addSpans(const Sheet& sheet, const SheetShift& shift, int y, std::size_t row,
                  bool straight, Layer& layer);

    glm::vec4 scale_;
    bool frontToBack_;
    std::size_t words_ = 0;  // of 64 tiles, a row
    /// [9][words_]: which tiles are full in the last row of the tile row before, and in the eight
    /// rows of the one in hand.
    std::vector<std::uint64_t> rows_;
    std::vector<std::uint64_t> either_;  // [words_]
    std::vector<OverSpan> spans_;
};

}  // namespace deltasplat
