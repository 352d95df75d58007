// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "splat/slice_blocks.h"

namespace deltasplat {

/// Makes sheets of footprints of a single pixel, where a voxel is seen in no other: writes the
/// colours of voxels, both digits at once, to the pixels that they have.
class PixelSplatter {
  public:
    static bool fits(const Footprint& footprint) { return footprint.width == 1; }

    /// Bytes that one takes, of a footprint that fits, without its sheet.
    static double bytes(const SplatInput& input, const SheetLayout& layout);

    /// @param input    with a footprint that fits
    /// @param largest  of the layouts to come
    /// @param sheet    of that layout; zero whenever a slab begins
    /// @param digit    of colours
    /// @param withLow  whether the low digit is added to this, the high one: there must be one
    PixelSplatter(const SplatInput& input, const SheetLayout& largest, Sheet& sheet,
                  DigitPlace digit, bool withLow);

    /// Takes on a layout, which the sheet must have by then.
    void setLayout(const SheetLayout& layout) { blocks_.setLayout(layout); }
    /// Makes the sheet that of the slice, after the one before it if it is not whole.
    /// @param needed  what will be read; the rest is made when it is
    void splat(int slice, bool whole, const NeededPixels& needed);
    /// Makes everything as it was before the first slice.
    void clear();

  private:
    using Pixel = std::array<std::int32_t, 4>;

    void splatWhole(int slice, const NeededPixels& needed);
    void splatChanges(int slice, const NeededPixels& needed);
    template <typename Use>
    void withValues(const SeenWord& word, const Use& use);
    // Of a block.
    template <typename Value>
    void writeVoxels(std::int32_t* tile, std::uint64_t voxels, const ClassIndex* classes,
                     const Value* values) const;
    template <typename Value>
    void writeRows(std::int32_t* tile, unsigned rows, const ClassIndex* classes,
                   const Value* values) const;
    Pixel pixelOf(const ClassTable::Color& high, const ClassTable::Color* low) const;

    SliceBlocks blocks_;
    Sheet& sheet_;
    std::int32_t one_;  // what a footprint adds up to
    // Of classes, one of both, as the sheet has channels.
    std::vector<Pixel> pixels_;
    std::vector<std::int32_t> opacities_;
    std::array<Pixel, 64> own_;  // of a word whose voxels have colours of their own
    std::vector<int> slices_;    // [block]: that was last written, of slabs that are whole
    std::vector<glm::ivec2> shownBlocks_;  // in such a slab, of the slice in hand
    std::vector<glm::ivec2> before_;       // of the slice before it
};

}  // namespace deltasplat
