// SPDX-License-Identifier: Apache-2.0
#include "splat/slice_blocks.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/bits.h"
#include "volume/block_kernels.h"

namespace deltasplat {

void LitSlice::begin(int slice) {
    if (hasSlice_ && slice == slice_) return;
    hasSlice_ = true;
    slice_ = slice;
    const std::span<const DeltaWord> words = deltas_.slice(slice);
    first_ = std::size_t(words.data() - deltas_.words.data());
    placeOf_.assign(words.size(), kUnlit);
    used_ = 0;
}

const LitWord& LitSlice::of(std::size_t word, int plane) {
    std::uint32_t& place = placeOf_[word - first_];
    if (place == kUnlit) {
        const std::size_t planes = colors_.table().planes.size();
        place = std::uint32_t(used_);
        used_ += planes;
        while (lit_.size() < used_) lit_.emplace_back();
        std::array<LitWord*, ClassTable::kMaxPlanes> out{};
        for (std::size_t p = 0; p < planes; ++p) out[p] = &lit_[place + p];
        colors_.light(word, slice_, out);
    }
    return lit_[place + std::size_t(plane)];
}

SliceBlocks::SliceBlocks(const SplatInput& input, const SheetLayout& layout, DigitPlace digit,
                         bool withLow)
    : input_(input),
      layout_(layout),
      firstBlock_(layout.firstVoxel / 8),
      stampEmptyVoxels_(input.stampEmptyVoxels && digit.plane == 0 && !digit.low),
      digit_(digit),
      colors_(digit.of(input.colors.table()).colors.data()) {
    const DigitVoxels* voxels = input.digitVoxels;
    if (voxels) voxels_ = voxels->of(digit);
    const bool hasPlanes = input.colors.table().planes.size() > 1;
    takesDigit_ = voxels_ || (input.lit && (hasPlanes || digit.low));
    if (!withLow) return;
    const DigitPlace low{digit.plane, true};
    lowColors_ = low.of(input.colors.table()).colors.data();
    if (voxels) lowVoxels_ = voxels->of(low);
}

// Returns the words of a slice in rows of blocks; words are ordered by u.
std::span<const DeltaWord> SliceBlocks::wordsOf(int slice, glm::ivec2 rows) const {
    const std::span<const DeltaWord> words = input_.deltas.slice(slice);
    const auto before = [](const DeltaWord& word, int u) { return word.block.x < u; };
    const auto first = std::lower_bound(words.begin(), words.end(), firstBlock_.y + rows.x, before);
    const int end = firstBlock_.y + std::max(rows.x, rows.y);
    return {first, std::lower_bound(first, words.end(), end, before)};
}

// Own colours lie in the order of voxels.
SeenWord SliceBlocks::litOf(const DeltaWord& word) const {
    static constexpr auto kInOrder = [] {
        std::array<ClassIndex, 64> places{};
        for (std::size_t n = 0; n < places.size(); ++n) places[n] = ClassIndex(n);
        return places;
    }();
    const LitWord& lit = input_.lit->of(numberOf(word), digit_.plane);
    const auto& colors = digit_.low ? lit.low : lit.high;
    return {word.visible, word.changed,      kInOrder.data(), colors.data(),
            true,         lowVoxelsOf(word), lit.low.data()};
}

// Returns voxels with the low digit, or, for the high digit, with anything on the plane.
std::uint64_t SliceBlocks::voxelsOfDigit(const DeltaWord& word) const {
    if (!input_.lit) return voxels_[numberOf(word)];
    const LitWord& lit = input_.lit->of(numberOf(word), digit_.plane);
    return digit_.low ? lit.anyLow : lit.any;
}

std::uint64_t SliceBlocks::lowVoxelsOf(const DeltaWord& word) const {
    if (!lowColors_) return 0;
    if (input_.lit) return input_.lit->of(numberOf(word), digit_.plane).anyLow;
    return lowVoxels_ ? lowVoxels_[numberOf(word)] : 0;
}

// Restricts a word to the digit; its changes to voxels that had or have it.
void SliceBlocks::takeDigit(const DeltaWord& word, bool whole, SeenWord& seen) {
    seen.visible = voxelsOfDigit(word);
    if (whole) return;
    if (shown_.size() < count()) shown_.resize(count());
    std::uint64_t& shown = shown_[placeOf(blockOf(word))];
    seen.changed &= shown | seen.visible;
    shown = seen.visible;
}

void SliceBlocks::clear() {
    std::fill(shown_.begin(), shown_.end(), 0);
    std::fill(waiting_.begin(), waiting_.end(), Waiting{});
    rowsBefore_ = {0, 0};
}

// Returns a mask word of the block's voxels in the volume's box.
std::uint64_t SliceBlocks::voxelsInBox(glm::ivec2 block) const {
    const IndexBox& box = input_.deltas.box;
    const glm::ivec2 first = layout_.firstVoxel + 8 * block;
    // Rows or columns of the block in the box; blocks that only fill up a tile have none.
    const auto inside = [](int from, int to) {
        if (from > 7 || to < 0) return 0u;
        return 0xFFu >> (7 - std::min(to, 7)) & 0xFFu << std::max(from, 0) & 0xFFu;
    };
    const std::uint64_t columns = inside(box.min.z - first.x, box.max.z - first.x);
    const unsigned rows = inside(box.min.y - first.y, box.max.y - first.y);
    std::uint64_t word = 0;
    for (int u = 0; u < 8; ++u) word |= (rows >> u & 1) * columns << 8 * u;
    return word;
}

// Whether all words, from the current row's on, are covered or between covered ones.
bool SliceBlocks::hidesAll(const SheetCover::Row& row, std::span<const DeltaWord> words) const {
    const glm::ivec2 first = blockOf(words.front());
    const glm::ivec2 last = blockOf(words.back());
    return first.y == last.y && hasColumn(first) && hasColumn(last) && row.hides(first.x, last.x);
}

// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9, for footprints that do not overlap: a voxel's old colour is overwritten.
namespace {

template <typename Value>
constexpr std::size_t kNumbersOf = sizeof(Value) / sizeof(std::int32_t);

}  // namespace

double PixelSplatter::bytes(const SplatInput& input, const SheetLayout& layout) {
    // Slices of blocks, two lists of shown blocks, and waiting changes.
    const double ofBlock = sizeof(int) + 4 * sizeof(glm::ivec2) + SliceBlocks::kBytesOfBlock;
    const double ofClass = sizeof(std::int32_t) * layout.channels;
    return ofBlock * double(layout.blocks.x) * layout.blocks.y +
           ofClass * double(input.colors.table().size());
}

PixelSplatter::PixelSplatter(const SplatInput& input, const SheetLayout& largest, Sheet& sheet,
                             DigitPlace digit, bool withLow)
    : blocks_(input, largest, digit, withLow),
      sheet_(sheet),
      one_(input.footprint.weights.front()),
      slices_(blocks_.count()) {
    const ClassTable& table = input.colors.table();
    const std::vector<ClassTable::Color>& high = digit.of(table).colors;
    const ClassTable::Color* low =
        withLow ? DigitPlace{digit.plane, true}.of(table).colors.data() : nullptr;
    largest.channels == 4 ? pixels_.reserve(high.size()) : opacities_.reserve(high.size());
    for (std::size_t i = 0; i < high.size(); ++i) {
        const Pixel pixel = pixelOf(high[i], low ? low + i : nullptr);
        if (largest.channels == 4) {
            pixels_.push_back(pixel);
        } else {
            opacities_.push_back(pixel[3]);
        }
    }
}

// The sum of stamps of both digits (Sheet::addDigits).
PixelSplatter::Pixel PixelSplatter::pixelOf(const ClassTable::Color& high,
                                            const ClassTable::Color* low) const {
    constexpr int kBits = ClassTable::kDigitBits;
    Pixel pixel;
    for (std::size_t c = 0; c < 4; ++c) {
        const std::int32_t fine = low ? (one_ * (*low)[c] + (1 << (kBits - 1))) >> kBits : 0;
        pixel[c] = one_ * high[c] + fine;
    }
    return pixel;
}

void PixelSplatter::splat(int slice, bool whole, const NeededPixels& needed) {
    if (whole) {
        splatWhole(slice, needed);
    } else {
        splatChanges(slice, needed);
    }
}

void PixelSplatter::splatChanges(int slice, const NeededPixels& needed) {
    blocks_.forChanges(
        slice, needed, [&](glm::ivec2 block, std::uint64_t changed, const SeenWord& word) {
            const Sheet::Tile tile = sheet_.tileOf(block);
            tile.full = rowsWithAny(word.visible);
            const unsigned rows = rowsWithAny(changed);
            const bool byVoxel = std::popcount(changed) <= kVoxelsOfRow * std::popcount(rows);
            withValues(word, [&](const auto* values) {
                if (byVoxel) {
                    writeVoxels(tile.pixels, changed, word.classes, values);
                } else {
                    writeRows(tile.pixels, rows, word.classes, values);
                }
            });
        });
}

// The previous slice is overwritten, or cleared by blocks. Unread rows, many at edges, stay.
void PixelSplatter::splatWhole(int slice, const NeededPixels& needed) {
    before_.swap(shownBlocks_);
    shownBlocks_.clear();
    blocks_.forWhole(
        slice, needed, [&](glm::ivec2 block, std::uint64_t voxels, const SeenWord& word) {
            const Sheet::Tile tile = sheet_.tileOf(block);
            const unsigned read = sheet_.rowsOfTile(block, needed.firstRow, needed.lastRow);
            const unsigned rows = (rowsWithAny(voxels) | tile.full) & read;
            if (rows != 0) {
                withValues(word, [&](const auto* values) {
                    writeRows(tile.pixels, rows, word.classes, values);
                });
            }
            tile.full = std::uint8_t((rowsWithAny(word.visible) & read) | (tile.full & ~read));
            slices_[blocks_.placeOf(block)] = slice;
            shownBlocks_.push_back(block);
        });
    for (const glm::ivec2 block : before_) {
        if (slices_[blocks_.placeOf(block)] != slice) sheet_.clear(sheet_.tileOf(block));
    }
}

void PixelSplatter::clear() {
    blocks_.clear();
    sheet_.clear();
    shownBlocks_.clear();
}

template <typename Use>
void PixelSplatter::withValues(const SeenWord& word, const Use& use) {
    if (word.hasOwn) {
        // All may differ, and have a low digit.
        for (std::size_t n = 0; n < own_.size(); ++n)
            own_[n] = pixelOf(word.colors[n], word.lowColors + n);
        use(own_.data());
    } else if (sheet_.layout().channels == 4) {
        use(pixels_.data());
    } else {
        use(opacities_.data());
    }
}

template <typename Value>
void PixelSplatter::writeVoxels(std::int32_t* tile, std::uint64_t voxels, const ClassIndex* classes,
                                const Value* values) const {
    const std::size_t pitch = sheet_.pitch();
    for (; voxels != 0; voxels &= voxels - 1) {
        const auto n = std::size_t(std::countr_zero(voxels));
        std::memcpy(tile + pitch * (n >> 3) + kNumbersOf<Value> * (n & 7), &values[classes[n]],
                    sizeof(Value));
    }
}

template <typename Value>
void PixelSplatter::writeRows(std::int32_t* tile, unsigned rows, const ClassIndex* classes,
                              const Value* values) const {
    const std::size_t pitch = sheet_.pitch();
    for (; rows != 0; rows &= rows - 1) {
        const auto u = std::size_t(std::countr_zero(rows));
        std::int32_t* const row = tile + pitch * u;
        for (std::size_t v = 0; v < 8; ++v)
            std::memcpy(row + kNumbersOf<Value> * v, &values[classes[8 * u + v]], sizeof(Value));
    }
}

}  // namespace deltasplat
