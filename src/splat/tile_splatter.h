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

/// Makes sheets of footprints that reach few voxels: writes what changes to a plane of colours, and
/// sums up the tiles of the sheet that it reaches.
class TileSplatter {
  public:
    /// Whether a footprint is small enough: as one of the weights says.
    static bool fits(const Footprint& footprint) {
        return TileWeights::fits(footprint) || CellWeights::fits(footprint);
    }

    /// Whether a footprint is wider than those of the smallest weights: such as CellWeights are
    /// for, and those that do not fit.
    static bool isWide(const Footprint& footprint) { return !TileWeights::fits(footprint); }

    /// Whether low digits are summed along with high ones.
    static bool addsLow(const Footprint& footprint) { return TileWeights::fits(footprint); }

    /// Returns how many voxels of a block a slice has to stamp for this to be faster than stamping
    /// them.
    static std::uint64_t leastStamps(const Footprint& footprint);

    /// Bytes that one takes, of a footprint that fits, without its sheet.
    static double bytes(const Footprint& footprint, const SheetLayout& layout, bool withLow);

    /// @param input    with a footprint that fits
    /// @param largest  of the layouts to come
    /// @param sheet    of that layout; zero whenever a slab begins
    /// @param digit    of colours
    /// @param withLow  whether the low digit is added to this, the high one: there must be one, and
    ///                 the smallest footprints, as addsLow() says
    TileSplatter(const SplatInput& input, const SheetLayout& largest, Sheet& sheet,
                 DigitPlace digit, bool withLow);

    /// Takes on a layout, which the sheet must have by then.
    void setLayout(const SheetLayout& layout) { blocks_.setLayout(layout); }
    /// Makes the sheet that of the slice, after the one before it if it is not whole.
    /// @param needed  what will be read; the rest is made when it is
    /// @param low     if not null, the sheet of the low digit, which is added
    void splat(int slice, bool whole, const NeededPixels& needed, const Sheet* low);
    /// Makes everything as it was before the first slice.
    void clear();

  private:
    // What is shown of a block.
    struct Shown {
        std::uint64_t voxels = 0;     // that may not be empty
        int slice = 0;                // that last painted it, in a slab that is whole
        std::uint64_t lowVoxels = 0;  // that have a low digit
    };

    struct PlaneSize {
        int margin;         // voxels before the first block and behind the last
        std::size_t pitch;  // numbers from one row to the next
        std::size_t rows;
    };

    // A digit of the colours shown.
    struct Plane {
        std::pmr::vector<std::int16_t> numbers;  // a margin around them
        std::vector<std::int16_t> opacities;     // of one colour: [classes]
    };

    // What the low digit takes besides.
    struct Low {
        Plane plane;
        std::vector<std::uint8_t> rows;  // [tile]: that may have it, as Sheet::mark() has them
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
    // Whether planes hold two rows together, as the smallest weights take them.
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
    std::optional<Low> low_;               // if summed along
    std::vector<std::uint8_t> lowRows_;    // [tile]: of another sheet, of the row of tiles in hand
    std::pmr::vector<Shown> shown_;        // [block]
    std::vector<glm::ivec2> shownBlocks_;  // those with voxels
    std::vector<glm::ivec2> before_;       // likewise, in the slice before
};

/// Makes sheets by stamping footprints of any size, one by one.
class StampSplatter {
  public:
    /// @param largest  of the layouts to come
    /// @param sheet    of that layout; zero whenever a slab begins
    /// @param digit    of colours
    StampSplatter(const SplatInput& input, const SheetLayout& largest, Sheet& sheet,
                  DigitPlace digit = {});

    /// Takes on a layout, which the sheet must have by then.
    void setLayout(const SheetLayout& layout);
    /// Makes the sheet that of the slice, after the one before it if it is not whole.
    /// @param needed  what will be read; the rest is made when it is
    void splat(int slice, bool whole, const NeededPixels& needed);
    /// Makes everything as it was before the first slice.
    void clear();

  private:
    void add(glm::ivec2 block, std::uint64_t voxels, const SeenWord& word, bool whole);

    const std::vector<ClassTable::Color>& colors_;
    bool hasOwn_;  // whether voxels have colours of their own
    SliceBlocks blocks_;
    Sheet& sheet_;
    StampWeights weights_;
    std::size_t mostBlocks_;  // of any layout
    /// Of a voxel's footprint, from its block's first one.
    std::array<std::uint32_t, 64> placeInBlock_;
    // Of the slice in hand, and [block][64], of slabs that are not whole; of own colours the second
    // ones.
    std::vector<BlockStamps> stamped_;
    std::pmr::vector<ClassIndex> shown_;
    std::vector<ColorStamps> stampedColors_;
    std::pmr::vector<ClassTable::Color> shownColors_;
};

}  // namespace deltasplat
