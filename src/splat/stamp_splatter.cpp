// SPDX-License-Identifier: Apache-2.0
// Based on: Lee Westover, "Footprint Evaluation for Volume Rendering", 1990.
#include "splat/stamp_splatter.h"

#include <algorithm>

#include "base/bits.h"

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
