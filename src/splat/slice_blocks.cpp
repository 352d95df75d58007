// SPDX-License-Identifier: Apache-2.0
#include "splat/slice_blocks.h"

#include <algorithm>

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

// The words of a slice in rows of blocks; they are ordered by u.
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

// Of the low digit, voxels that have it; of the high one, those that have anything on the plane.
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

// Leaves what a word is of the digit. Of changes, those of voxels that had it or have it.
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

// Returns a mask word of the voxels of a block that lie in the volume's box.
std::uint64_t SliceBlocks::voxelsInBox(glm::ivec2 block) const {
    const IndexBox& box = input_.deltas.box;
    const glm::ivec2 first = layout_.firstVoxel + 8 * block;
    // Of the block's rows or columns those of the box; of blocks that fill up a tile none.
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

// Whether words from one of the row in hand on are all covered, or lie between such.
bool SliceBlocks::hidesAll(const SheetCover::Row& row, std::span<const DeltaWord> words) const {
    const glm::ivec2 first = blockOf(words.front());
    const glm::ivec2 last = blockOf(words.back());
    return first.y == last.y && hasColumn(first) && hasColumn(last) && row.hides(first.x, last.x);
}

}  // namespace deltasplat
