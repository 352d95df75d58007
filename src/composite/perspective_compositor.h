// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <utility>
#include <vector>

#include "composite/layer.h"
#include "composite/scaled_kernels.h"
#include "splat/sheet_cover.h"

namespace deltasplat {

/// Composites sheets into layers where lines of sight come from an eye: what Compositor does in
/// parallel projection. Holds what that takes, to be used for one slice after the other; not
/// thread-safe.
class PerspectiveCompositor {
  public:
    using Sheets = std::span<const Sheet* const>;

    /// @param scales  what one unit of each sheet is worth in each channel
    /// @param steps   how long the way through a slice is; of layers of opacity alone, whose
    /// lengths are made up for once they are merged, null
    PerspectiveCompositor(const BasePlane& plane, std::vector<glm::vec4> scales,
                          const StepLengths* steps)
        : plane_(plane), scales_(std::move(scales)), steps_(steps) {}

    /// Composites what the base plane's pixels of a box, which the layer has, see of one slice. A
    /// slice that the eye or the near plane cuts counts as far as it lies beyond.
    /// @param cover  of the slice: what it hides is left out; null: nothing is hidden
    /// @return       how many pixels of the layer it went over
    std::size_t composite(Sheets sheets, int slice, const SheetReading& reading,
                          const PlaneBox& box, const SheetCover* cover, Layer& layer);

  private:
    void findFull(Sheets sheets, int firstRow, int lastRow, const SheetCover* cover);
    PlaneBox seenBox(Sheets sheets, const SheetReading& reading, const PlaneBox& box,
                     const SheetCover* cover);
    void findTiles(const SheetReading& reading, int tiles);
    void addRow(int y, Layer& layer);
    void addRun(glm::ivec2 first, int last, Layer& layer);
    void flush();
    const float* stepsOf(glm::ivec2 first, int pixels);

    const BasePlane& plane_;
    std::vector<glm::vec4> scales_;
    const StepLengths* steps_;
    int number_ = 0;                   // of the slice in hand
    bool isCut_ = false;               // it is, by the eye or the near plane
    PlaneBox box_;                     // of it
    ScaledTaps columns_;               // of the box
    ScaledTaps rows_;                  // likewise
    std::vector<glm::ivec2> tiles_;    // [tiles]: columns [x, y) of the box that read each
    std::size_t words_ = 0;            // of 64 tiles, a row
    int firstTileRow_ = 0;             // that full_ begins with
    int firstFull_ = 0;                // of the sheet rows that may be other than zero
    int lastFull_ = 0;                 // likewise, behind the last
    std::vector<std::uint64_t> full_;  // [sheet row][words_]: which tiles are full
    std::vector<std::uint64_t> seen_;  // [words_]: of the rows that a base plane row reads
    ScaledSlice slice_{};
    std::vector<ScaledRun> runs_;  // that wait to be composited
    std::size_t pixels_ = 0;       // of the slice in hand, that are composited
    std::vector<float> shares_;    // steps of a run through a slice that is cut
};

}  // namespace deltasplat
