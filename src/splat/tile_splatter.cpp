// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9. Deviates in that pixels take from voxels what voxels would stamp: the same integers.
#include "splat/tile_splatter.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/bits.h"
#include "splat/paint_kernels.h"
#include "splat/tile_bytes.h"

namespace deltasplat {

namespace {

using Weights = std::variant<TileWeights, CellWeights>;

Weights weightsOf(const Footprint& footprint, int channels) {
    if (TileWeights::fits(footprint)) return TileWeights(footprint, channels);
    return CellWeights(footprint, channels);
}

}  // namespace

// Measured (docs/decisions.md, "Few changes are stamped").
std::uint64_t TileSplatter::leastStamps(const Footprint& footprint) {
    return TileWeights::fits(footprint) ? 12 : 20;
}

// Tiles read one voxel beyond their own, inside the outermost tile, which is never touched. Cells
// need not begin where tiles do, and read more.
TileSplatter::PlaneSize TileSplatter::planeSize(const Footprint& footprint,
                                                const SheetLayout& layout) {
    const int margin =
        layout.marginPixels / layout.resolution + (isWide(footprint) ? CellWeights::kMostTaps : 0);
    return {margin, std::size_t(layout.channels) * (8 * layout.blocks.x + 2 * margin + 8),
            std::size_t(8 * layout.blocks.y + 2 * margin)};
}

TileSplatter::TileSplatter(const SplatInput& input, const SheetLayout& largest, Sheet& sheet,
                           DigitPlace digit, bool withLow)
    : blocks_(input, largest, digit, withLow),
      sheet_(sheet),
      weights_(weightsOf(input.footprint, largest.channels)),
      size_(planeSize(input.footprint, largest)),
      high_(planeOf(digit.of(input.colors.table()).colors, input.memory)),
      shown_(blocks_.count(), &input.memory) {
    if (!withLow) return;
    const DigitPlace low{digit.plane, true};
    low_.emplace(Low{planeOf(low.of(input.colors.table()).colors, input.memory),
                     std::vector<std::uint8_t>(sheet.markBytes())});
}

TileSplatter::Plane TileSplatter::planeOf(const std::vector<ClassTable::Color>& colors,
                                          std::pmr::memory_resource& memory) const {
    Plane plane{std::pmr::vector<std::int16_t>(size_.pitch * size_.rows, &memory), {}};
    if (sheet_.layout().channels == 4) return plane;
    for (const ClassTable::Color& color : colors) plane.opacities.push_back(color[3]);
    return plane;
}

double TileSplatter::bytes(const Footprint& footprint, const SheetLayout& layout, bool withLow) {
    const PlaneSize plane = planeSize(footprint, layout);
    const double blocks = double(layout.blocks.x) * layout.blocks.y;
    // Slices of blocks, two lists of shown blocks, and waiting changes.
    const double ofBlock = sizeof(Shown) + 4 * sizeof(glm::ivec2) + SliceBlocks::kBytesOfBlock;
    const double ofPlane = double(sizeof(std::int16_t)) * double(plane.pitch) * double(plane.rows);
    return (withLow ? 2 : 1) * ofPlane + ofBlock * blocks;
}

void TileSplatter::splat(int slice, bool whole, const NeededPixels& needed, const Sheet* low) {
    if (whole) {
        paintWhole(slice, needed);
    } else {
        paintChanges(slice, needed);
    }
    const auto refill = [&](int row, std::span<const std::uint8_t> touched,
                            std::span<std::uint8_t> full) {
        sumTiles(row, touched, full);
        if (low) addLow(*low, row, touched, full);
    };
    if (!needed.cover) return sheet_.refillTouched(needed.firstRow, needed.lastRow, refill);
    const auto isHidden = [&](glm::ivec2 tile) {
        return needed.cover->tileRow(tile.y).hides(tile.x);
    };
    sheet_.refillTouched(needed.firstRow, needed.lastRow, isHidden, refill);
}

// Rows between touched ones were made too.
void TileSplatter::addLow(const Sheet& low, int row, std::span<const std::uint8_t> touched,
                          std::span<std::uint8_t> full) {
    lowRows_.assign(touched.size(), 0);
    const std::span<const std::uint8_t> lowFull = low.fullRows(row);
    forTiles(touched, [&](std::size_t i) {
        lowRows_[i] = std::uint8_t(withRowsBetween(touched[i]) & lowFull[i]);
    });
    const TileRow tiles = sheet_.tileRow(row);
    addLowDigits({tiles.sheet, low.row(kTilePixels * row), tiles.sheetPitch},
                 sheet_.layout().channels, lowRows_, tiles.sheet, full);
}

void TileSplatter::sumTiles(int row, std::span<const std::uint8_t> touched,
                            std::span<std::uint8_t> full) {
    const TileRow tiles = sheet_.tileRow(row);
    if (const auto* weights = std::get_if<TileWeights>(&weights_)) {
        LowRow low;
        if (low_)
            low = {pairedRow(low_->plane, row),
                   {&low_->rows[touched.size() * row], touched.size()}};
        splatTiles(*weights, pairedRow(high_, row), low, tiles, touched, full);
    } else {
        const glm::ivec2 pixel(0, kTilePixels * row);
        const CellPlane from{numbersAt(high_, glm::ivec2(size_.margin)), size_.pitch,
                             pixel - sheet_.layout().marginPixels};
        splatCells(std::get<CellWeights>(weights_), from, tiles, touched, full);
    }
}

PairedRow TileSplatter::pairedRow(Plane& plane, int row) const {
    return {planeRow(plane, row).first, 2 * size_.pitch};
}

// The voxels of a row of tiles; like margins, it begins with a voxel.
PlaneRow TileSplatter::planeRow(Plane& plane, int row) const {
    const SheetLayout& layout = sheet_.layout();
    const int voxel = kTilePixels * row / layout.resolution;
    return {numbersAt(plane, {0, voxel}), size_.pitch};
}

void TileSplatter::clear() {
    blocks_.clear();
    for (const glm::ivec2 block : shownBlocks_) takeAway(block);
    shownBlocks_.clear();
    sheet_.clear();
    if (low_) std::fill(low_->rows.begin(), low_->rows.end(), std::uint8_t{0});
}

void TileSplatter::paintChanges(int slice, const NeededPixels& needed) {
    blocks_.forChanges(slice, needed,
                       [&](glm::ivec2 block, std::uint64_t changed, const SeenWord& word) {
                           Shown& shown = shown_[blocks_.placeOf(block)];
                           if (shown.voxels == 0) shownBlocks_.push_back(block);
                           shown.voxels |= changed;
                           paint(block, changed, word);
                       });
}

// Only voxels of the previous slice that are not painted over are removed.
void TileSplatter::paintWhole(int slice, const NeededPixels& needed) {
    before_.swap(shownBlocks_);
    shownBlocks_.clear();
    blocks_.forWhole(slice, needed,
                     [&](glm::ivec2 block, std::uint64_t active, const SeenWord& word) {
                         Shown& shown = shown_[blocks_.placeOf(block)];
                         paint(block, active | shown.voxels, word);
                         shown.voxels = active;
                         shown.slice = slice;
                         shownBlocks_.push_back(block);
                     });
    for (const glm::ivec2 block : before_) {
        if (shown_[blocks_.placeOf(block)].slice != slice) takeAway(block);
    }
}

void TileSplatter::takeAway(glm::ivec2 block) {
    Shown& shown = shown_[blocks_.placeOf(block)];
    if (shown.voxels != 0) paint(block, shown.voxels, blocks_.nothingSeen());
    shown.voxels = 0;
}

void TileSplatter::paint(glm::ivec2 block, std::uint64_t voxels, const SeenWord& word) {
    sheet_.touch(block, voxels);
    paintPlane(high_, block, voxels, word.classes, word.colors);
    if (!low_) return;
    std::uint64_t& lowVoxels = shown_[blocks_.placeOf(block)].lowVoxels;
    if (word.lowVoxels != 0) sheet_.mark(block, word.lowVoxels, low_->rows);
    const std::uint64_t either = word.lowVoxels | std::exchange(lowVoxels, word.lowVoxels);
    if (either != 0) paintPlane(low_->plane, block, voxels & either, word.classes, word.lowColors);
}

void TileSplatter::paintPlane(Plane& plane, glm::ivec2 block, std::uint64_t voxels,
                              const ClassIndex* classes, const ClassTable::Color* colors) {
    std::int16_t* numbers = numbersAt(plane, 8 * block + size_.margin);
    const bool hasColors = sheet_.layout().channels == 4;
    if (isPaired() && hasColors)
        return paintPairs(voxels, classes, colors, numbers, 2 * size_.pitch);
    if (isPaired())
        return paintPairs(voxels, classes, plane.opacities.data(), numbers, 2 * size_.pitch);
    if (hasColors) return paintColors(numbers, voxels, classes, colors);
    for (int u = 0; u < 8; ++u, numbers += size_.pitch, classes += 8) {
        for (int v = 0; v < 8; ++v) numbers[v] = plane.opacities[classes[v]];
    }
}

void TileSplatter::paintColors(std::int16_t* plane, std::uint64_t voxels, const ClassIndex* classes,
                               const ClassTable::Color* colors) const {
    // For most voxels, writing all is faster.
    constexpr int kFew = 24;
    if (std::popcount(voxels) >= kFew) {
        for (int u = 0; u < 8; ++u, plane += size_.pitch) {
            for (int v = 0; v < 8; ++v)
                std::memcpy(plane + 4 * v, &colors[*classes++], sizeof *colors);
        }
        return;
    }
    for (std::uint64_t rest = voxels; rest != 0; rest &= rest - 1) {
        const int n = std::countr_zero(rest);
        std::memcpy(plane + (n >> 3) * size_.pitch + 4 * (n & 7), &colors[classes[n]],
                    sizeof *colors);
    }
}

// @param voxel  of an even row, where rows lie in pairs
std::int16_t* TileSplatter::numbersAt(Plane& plane, glm::ivec2 voxel) const {
    const auto numbers = std::size_t(sheet_.layout().channels) * (isPaired() ? 2 : 1);
    return &plane.numbers[size_.pitch * voxel.y + numbers * voxel.x];
}

// Based on: Lee Westover, "Footprint Evaluation for Volume Rendering", 1990.
StampSplatter::StampSplatter(const SplatInput& input, const SheetLayout& largest, Sheet& sheet,
                             DigitPlace digit)
    : colors_(digit.of(input.colors.table()).colors),
      hasOwn_(input.colors.own() != nullptr),
      blocks_(input, largest, digit),
      sheet_(sheet),
      weights_(input.footprint, largest.channels),
      mostBlocks_(blocks_.count()),
      shown_(&input.memory),
      shownColors_(&input.memory) {
    setLayout(largest);
}

void StampSplatter::setLayout(const SheetLayout& layout) {
    blocks_.setLayout(layout);
    for (int n = 0; n < 64; ++n) {
        const std::size_t pixels = std::size_t(n >> 3) * layout.pitchPixels() + (n & 7);
        placeInBlock_[n] = std::uint32_t(pixels * layout.resolution);
    }
}

void StampSplatter::splat(int slice, bool whole, const NeededPixels& needed) {
    stamped_.clear();
    stampedColors_.clear();
    const auto addTo = [&](glm::ivec2 block, std::uint64_t voxels, const SeenWord& word) {
        add(block, voxels, word, whole);
    };
    const StampPlaces places{placeInBlock_.data(), sheet_.pitch()};
    if (whole) {
        sheet_.clear();
        blocks_.forWhole(slice, needed, addTo);
        stampWhole(stamped_, colors_.data(), weights_, places);
        stampWhole(stampedColors_, weights_, places);
    } else {
        if (hasOwn_ && shownColors_.empty()) shownColors_.resize(64 * mostBlocks_);
        if (!hasOwn_ && shown_.empty()) shown_.resize(64 * mostBlocks_);
        blocks_.forChanges(slice, needed, addTo);
        stampChanges(stamped_, colors_.data(), weights_, places);
        stampChanges(stampedColors_, weights_, places);
    }
    sheet_.settle();
}

void StampSplatter::add(glm::ivec2 block, std::uint64_t voxels, const SeenWord& word, bool whole) {
    const SheetLayout& layout = sheet_.layout();
    sheet_.show(block, word.visible, whole ? 0 : voxels & ~word.visible);
    const std::size_t place = layout.stampPlace(layout.firstVoxel + 8 * block);
    std::int32_t* first = sheet_.pixels() + layout.channels * place;
    const std::size_t shown = 64 * blocks_.placeOf(block);
    if (word.hasOwn) {
        stampedColors_.push_back(
            {transposedBits(voxels), word.colors, whole ? nullptr : &shownColors_[shown], first});
    } else {
        stamped_.push_back(
            {transposedBits(voxels), word.classes, whole ? nullptr : &shown_[shown], first});
    }
}

void StampSplatter::clear() {
    blocks_.clear();
    sheet_.clear();
    std::fill(shown_.begin(), shown_.end(), ClassIndex{kEmptySlot});
    std::fill(shownColors_.begin(), shownColors_.end(), ClassTable::Color{});
}

}  // namespace deltasplat
