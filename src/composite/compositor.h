// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <utility>
#include <vector>

#include "composite/layer.h"
#include "composite/over_kernels.h"
#include "splat/sheet_cover.h"

namespace deltasplat {

/// Composites sheets into layers. Holds what that takes, to be used for one slice after the other;
/// not thread-safe.
class Compositor {
  public:
    /// Sheets of a slice, one for each plane of colours, all of one layout.
    using Sheets = std::span<const Sheet* const>;

    /// @param scales  what one unit of each sheet is worth in each channel
    explicit Compositor(std::vector<glm::vec4> scales) : scales_(std::move(scales)) {}

    /// Composites one slice: the sum of its sheets, read bilinearly at the layer's pixels, goes
    /// behind what the layer holds. Only what the sheets' full rows reach is touched; of that, rows
    /// [firstRow, lastRow) of the base plane, which the layer has.
    /// @param cover  of the slice: what it hides is left out; null: nothing is hidden
    /// @return       how many pixels of the layer it went over
    std::size_t composite(Sheets sheets, const SheetReading& shift, int firstRow, int lastRow,
                          const SheetCover* cover, Layer& layer);

  private:
    // Rows of tiles as bits, 64 tiles a word.
    using Rows = std::vector<std::uint64_t>;

    void findSpans(Sheets sheets, const SheetReading& shift, int firstRow, int lastRow,
                   bool straight, const SheetCover* cover, Layer& layer);
    void addSpans(const Sheet& sheet, const SheetReading& shift, int y, std::size_t row,
                  bool straight, Layer& layer);
    void addRun(int firstTile, int lastTile, bool straight, OverSpan span, int channels);
    std::uint32_t planesAt(int tile) const;

    std::vector<glm::vec4> scales_;
    std::size_t words_ = 0;  // a row
    /// [plane][9][words_]: which tiles are full in the last row of the tile row before, and in the
    /// eight rows of the one in hand.
    std::vector<Rows> rows_;
    std::vector<Rows> either_;  // [plane][words_], and of all planes together behind them
    std::vector<OverSpan> spans_;
};

}  // namespace deltasplat
