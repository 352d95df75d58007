// SPDX-License-Identifier: Apache-2.0
// Based on: Lee Westover, "Footprint Evaluation for Volume Rendering", 1990.
#include "splat/stamp_splatter.h"

#include <algorithm>

#include "bit_matrix.h"

namespace deltasplat {

StampSplatter::StampSplatter(const SplatInput& input, const SheetLayout& largest, Sheet& sheet,
                             DigitPlace digit)
    : colors_(digit.of(input.colors.table()).colors),
      hasOwn_(input.colors.own() != nullptr),
      blocks_(input, largest, digit),
      sheet_(sheet),
      weights_(input.footprint, largest.channels),
      mostBlocks_(blocks_.count()),
      shown_(&input.memory),
      shownColors_(&input.memory),
      waiting_(&input.memory) {
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
    if (whole) {
        stampWholeSlice(slice, needed);
    } else {
        stampChangesOf(slice, needed);
    }
    sheet_.settle();
}

void StampSplatter::stampWholeSlice(int slice, const NeededPixels& needed) {
    sheet_.clear();
    blocks_.forEach(
        slice, true, needed, [&](glm::ivec2 block, std::uint64_t active, const SeenWord& word) {
            sheet_.show(block, word.visible, 0);
            const std::uint64_t byColumn = transposedBits(active);
            if (word.hasOwn) {
                stampedColors_.push_back({byColumn, word.colors, nullptr, firstOf(block)});
            } else {
                stamped_.push_back({byColumn, word.classes, nullptr, firstOf(block)});
            }
        });
    const StampPlaces places{placeInBlock_.data(), sheet_.pitch()};
    stampWhole(stamped_, colors_.data(), weights_, places);
    stampWhole(stampedColors_, weights_, places);
}

// Changes in rows that are needed later, or never, wait: each word knows all voxels of its block,
// so that the last one says it all. Not so colours of a word's own, which are those of this slice.
void StampSplatter::stampChangesOf(int slice, const NeededPixels& needed) {
    if (hasOwn_ && shownColors_.empty()) shownColors_.resize(64 * mostBlocks_);
    if (!hasOwn_ && shown_.empty()) {
        shown_.resize(64 * mostBlocks_);
        waiting_.resize(mostBlocks_);
    }
    const glm::ivec2 rows = blocks_.rowsNeeded(needed);
    blocks_.forEach(
        slice, false, needed, [&](glm::ivec2 block, std::uint64_t active, const SeenWord& word) {
            const std::size_t place = blocks_.placeOf(block);
            if (word.hasOwn) {
                sheet_.show(block, word.visible, active & ~word.visible);
                stampedColors_.push_back({transposedBits(active), word.colors,
                                          &shownColors_[64 * place], firstOf(block)});
                return;
            }
            waiting_[place] = {waiting_[place].voxels | active, word.visible, word.classes};
            if (block.y >= rows.x && block.y < rows.y) addWaiting(block);
        });
    if (!hasOwn_) blocks_.forEntering(needed, [&](glm::ivec2 block) { addWaiting(block); });
    const StampPlaces places{placeInBlock_.data(), sheet_.pitch()};
    stampChanges(stamped_, colors_.data(), weights_, places);
    stampChanges(stampedColors_, weights_, places);
}

void StampSplatter::addWaiting(glm::ivec2 block) {
    const std::size_t place = blocks_.placeOf(block);
    Waiting& waiting = waiting_[place];
    if (waiting.voxels == 0) return;
    sheet_.show(block, waiting.visible, waiting.voxels & ~waiting.visible);
    stamped_.push_back(
        {transposedBits(waiting.voxels), waiting.classes, &shown_[64 * place], firstOf(block)});
    waiting.voxels = 0;
}

// Where the footprint of a block's first voxel begins.
std::int32_t* StampSplatter::firstOf(glm::ivec2 block) {
    const SheetLayout& layout = sheet_.layout();
    return sheet_.pixels() + layout.channels * layout.stampPlace(layout.firstVoxel + 8 * block);
}

void StampSplatter::clear() {
    blocks_.clear();
    sheet_.clear();
    std::fill(shown_.begin(), shown_.end(), ClassIndex{kEmptySlot});
    std::fill(shownColors_.begin(), shownColors_.end(), ClassTable::Color{});
    std::fill(waiting_.begin(), waiting_.end(), Waiting{});
}

}  // namespace deltasplat
