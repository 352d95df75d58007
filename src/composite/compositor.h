// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <glm/vec4.hpp>
#include <span>
#include <utility>
#include <vector>

#include "base/bits.h"
#include "composite/layer.h"
#include "composite/over_kernels.h"
#include "composite/scaled_kernels.h"
#include "splat/sheet.h"
#include "splat/sheet_cover.h"

namespace deltasplat {

/// Turns a sheet's row of tiles into a row of bits per pixel row, 64 tiles per word.
/// @param rows   [kTilePixels][words], zeros
/// @return bit y: whether row y has any
inline unsigned findFullRows(const Sheet& sheet, int tileRow, std::size_t words,
                             std::span<std::uint64_t> rows) {
    const std::span<const std::uint8_t> tiles = sheet.fullRows(tileRow);
    std::uint64_t any = 0;
    for (std::size_t i = 0; i < tiles.size(); i += 8) {
        std::uint64_t bytes;
        std::memcpy(&bytes, &tiles[i], sizeof bytes);
        if (bytes == 0) continue;
        any |= bytes;
        bytes = transposedBits(bytes);
        for (std::size_t y = 0; y < kTilePixels; ++y)
            rows[y * words + i / 64] |= (bytes >> (8 * y) & 0xFF) << (i % 64);
    }
    any |= any >> 32;
    any |= any >> 16;
    return unsigned(any | any >> 8) & 0xFF;
}

/// Returns the words of 64 tiles per row of a sheet.
inline std::size_t wordsOfRow(const Sheet& sheet) {
    return (sheet.fullRows(0).size() + 63) / 64;
}

/// Calls emit(first, last) for every run of set bits [first, last) in a row of words.
template <typename Emit>
void forEachRun(std::span<const std::uint64_t> words, const Emit& emit) {
    int open = -1;  // start of a run that reaches the current word
    for (std::size_t i = 0; i < words.size(); ++i) {
        const int base = int(64 * i);
        std::uint64_t word = words[i];
        int bit = 0;
        while (bit < 64) {
            const std::uint64_t rest = (open < 0 ? word : ~word) >> bit;
            if (rest == 0) break;
            bit += std::countr_zero(rest);
            if (open < 0) {
                open = base + bit;
            } else {
                emit(open, base + bit);
                open = -1;
            }
        }
    }
    if (open >= 0) emit(open, int(64 * words.size()));
}

/// Composites sheets into layers, slice after slice. Not thread-safe.
class Compositor {
  public:
    /// Sheets of a slice, one per plane of colours, all of one layout.
    using Sheets = std::span<const Sheet* const>;

    /// @param scales  value of one unit of each sheet, per channel
    explicit Compositor(std::vector<glm::vec4> scales) : scales_(std::move(scales)) {}

    /// Composites one slice: the sum of its sheets, read bilinearly at the layer's pixels, goes
    /// behind the layer. Only rows [firstRow, lastRow) of the base plane, which the layer has, are
    /// touched, where the sheets' full rows reach.
    /// @param cover  of the slice: hidden tiles are left out; null: none are
    /// @return       the number of pixels composited
    std::size_t composite(Sheets sheets, const SheetReading& shift, int firstRow, int lastRow,
                          const SheetCover* cover, Layer& layer);

  private:
    using Rows = std::vector<std::uint64_t>;

    void findSpans(Sheets sheets, const SheetReading& shift, int firstRow, int lastRow,
                   bool straight, const SheetCover* cover, Layer& layer);
    void addSpans(const Sheet& sheet, const SheetReading& shift, int y, std::size_t row,
                  bool straight, Layer& layer);
    void addRun(int firstTile, int lastTile, bool straight, OverSpan span, int channels);
    std::uint32_t planesAt(int tile) const;

    std::vector<glm::vec4> scales_;
    std::size_t words_ = 0;  // a row
    /// [plane][9][words_]: full tiles in the previous tile row's last row, and the current one's.
    std::vector<Rows> rows_;
    std::vector<Rows> either_;  // [plane][words_], then all planes together
    std::vector<OverSpan> spans_;
};

/// Composites sheets into layers, slice after slice, as seen from an eye. Not thread-safe.
class PerspectiveCompositor {
  public:
    using Sheets = std::span<const Sheet* const>;

    /// @param scales  value of one unit of each sheet, per channel
    /// @param steps   length of the way through a slice; null: opacities, corrected after merging
    PerspectiveCompositor(const BasePlane& plane, std::vector<glm::vec4> scales,
                          const StepLengths* steps)
        : plane_(plane), scales_(std::move(scales)), steps_(steps) {}

    /// Composites one slice as seen by the base plane's pixels of a box, which the layer has. A
    /// slice cut by the eye or the near plane counts beyond the cut.
    /// @param cover  of the slice: hidden tiles are left out; null: none are
    /// @return       the number of pixels composited
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
    int number_ = 0;                   // of the current slice
    bool isCut_ = false;               // by the eye or the near plane
    PlaneBox box_;                     // of the slice
    ScaledTaps columns_;               // of the box
    ScaledTaps rows_;                  // likewise
    std::vector<glm::ivec2> tiles_;    // [tiles]: columns [x, y) of the box that read it
    std::size_t words_ = 0;            // words of 64 tiles per row
    int firstTileRow_ = 0;             // first tile row of full_
    int firstFull_ = 0;                // first sheet row that may be other than zero
    int lastFull_ = 0;                 // behind the last such row
    std::vector<std::uint64_t> full_;  // [sheet row][words_]: full tiles
    std::vector<std::uint64_t>
        seen_;  // [words_]: full tiles of the rows that a base plane row reads
    ScaledSlice slice_{};
    std::vector<ScaledRun> runs_;  // still to be composited
    std::size_t pixels_ = 0;       // composited in the current slice
    std::vector<float> shares_;    // steps of a run through a cut slice
};

}  // namespace deltasplat
