// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "splat/cell_kernels.h"
#include "splat/slice_blocks.h"
#include "splat/stamp_kernels.h"
#include "splat/tile_kernels.h"

namespace deltasplat {

/// Makes sheets of footprints that reach few voxels: writes changes to a plane of colours, and sums
/// up the tiles of the sheet that changes reach.
class TileSplatter {
  public:
    static bool fits(const Footprint& footprint) {
        return TileWeights::fits(footprint) || CellWeights::fits(footprint);
    }

    /// Whether a footprint needs CellWeights, or more.
    static bool isWide(const Footprint& footprint) { return !TileWeights::fits(footprint); }

    static bool addsLow(const Footprint& footprint) { return TileWeights::fits(footprint); }

    /// Returns the stamps per slice of a block from which this is faster than stamping.
    static std::uint64_t leastStamps(const Footprint& footprint);

    /// Bytes for a footprint that fits, without the sheet.
    static double bytes(const Footprint& footprint, const SheetLayout& layout, bool withLow);

    /// @param input    with a footprint that fits
    /// @param largest  of all layouts to come
    /// @param sheet    of that layout; zero whenever a slab begins
    /// @param withLow  whether the low digit (required) is added to this high one (addsLow())
    TileSplatter(const SplatInput& input, const SheetLayout& largest, Sheet& sheet,
                 DigitPlace digit, bool withLow);

    /// The sheet must have the layout already.
    void setLayout(const SheetLayout& layout) { blocks_.setLayout(layout); }
    /// Turns the sheet into the slice's, from that of the previous slice unless it is whole.
    /// @param needed  pixels that will be read; others are made once needed
    /// @param low     sheet of the low digit to add, or null
    void splat(int slice, bool whole, const NeededPixels& needed, const Sheet* low);
    void clear();

  private:
    // What a block shows.
    struct Shown {
        std::uint64_t voxels = 0;     // that may not be empty
        int slice = 0;                // that last painted it, in a whole slab
        std::uint64_t lowVoxels = 0;  // that have a low digit
    };

    struct PlaneSize {
        int margin;         // voxels before the first block and behind the last
        std::size_t pitch;  // numbers from one row to the next
        std::size_t rows;
    };

    struct Plane {
        std::pmr::vector<std::int16_t> numbers;  // a margin around them
        std::vector<std::int16_t> opacities;     // of one colour: [classes]
    };

    struct Low {
        Plane plane;
        std::vector<std::uint8_t> rows;  // [tile]: rows that may have it, as in Sheet::mark()
    };

    static PlaneSize planeSize(const Footprint& footprint, const SheetLayout& layout);
    Plane planeOf(const std::vector<ClassTable::Color>& colors,
                  std::pmr::memory_resource& memory) const;
    void paintChanges(int slice, const NeededPixels& needed);
    void paintWhole(int slice, const NeededPixels& needed);
    void takeAway(glm::ivec2 block);
    void sumTiles(int row, std::span<const std::uint8_t> touched, std::span<std::uint8_t> full);
    void addLow(const Sheet& low, int row, std::span<const std::uint8_t> touched,
                std::span<std::uint8_t> full);
    PlaneRow planeRow(Plane& plane, int row) const;
    PairedRow pairedRow(Plane& plane, int row) const;
    // Whether planes interleave two rows, for TileWeights.
    bool isPaired() const { return std::holds_alternative<TileWeights>(weights_); }
    void paint(glm::ivec2 block, std::uint64_t voxels, const SeenWord& word);
    void paintPlane(Plane& plane, glm::ivec2 block, std::uint64_t voxels, const ClassIndex* classes,
                    const ClassTable::Color* colors);
    void paintColors(std::int16_t* plane, std::uint64_t voxels, const ClassIndex* classes,
                     const ClassTable::Color* colors) const;
    std::int16_t* numbersAt(Plane& plane, glm::ivec2 voxel) const;

    SliceBlocks blocks_;
    Sheet& sheet_;
    std::variant<TileWeights, CellWeights> weights_;
    PlaneSize size_;  // of planes
    Plane high_;
    std::optional<Low> low_;  // if summed along
    std::vector<std::uint8_t>
        lowRows_;                    // [tile]: rows of another sheet, in the current row of tiles
    std::pmr::vector<Shown> shown_;  // [block]
    std::vector<glm::ivec2> shownBlocks_;  // blocks with voxels
    std::vector<glm::ivec2> before_;       // likewise, in the previous slice
};

/// Makes sheets by stamping footprints of any size, one by one.
class StampSplatter {
  public:
    /// @param largest  of all layouts to come
    /// @param sheet    of that layout; zero whenever a slab begins
    StampSplatter(const SplatInput& input, const SheetLayout& largest, Sheet& sheet,
                  DigitPlace digit = {});

    /// The sheet must have the layout already.
    void setLayout(const SheetLayout& layout);
    /// Turns the sheet into the slice's, from that of the previous slice unless it is whole.
    /// @param needed  pixels that will be read; others are made once needed
    void splat(int slice, bool whole, const NeededPixels& needed);
    void clear();

  private:
    void add(glm::ivec2 block, std::uint64_t voxels, const SeenWord& word, bool whole);

    const std::vector<ClassTable::Color>& colors_;
    bool hasOwn_;  // whether voxels have colours of their own
    SliceBlocks blocks_;
    Sheet& sheet_;
    StampWeights weights_;
    std::size_t mostBlocks_;  // of any layout
    /// Offset of a voxel's footprint from its block's first one.
    std::array<std::uint32_t, 64> placeInBlock_;
    // Of the slice, and [block][64] in slabs that are not whole; the second pair: own colours.
    std::vector<BlockStamps> stamped_;
    std::pmr::vector<ClassIndex> shown_;
    std::vector<ColorStamps> stampedColors_;
    std::pmr::vector<ClassTable::Color> shownColors_;
};

}  // namespace deltasplat
