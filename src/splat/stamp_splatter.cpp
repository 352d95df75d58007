// SPDX-License-Identifier: Apache-2.0
// Based on: Lee Westover, "Footprint Evaluation for Volume Rendering", 1990.
#include "splat/stamp_splatter.h"

#include <algorithm>

namespace deltasplat {

StampSplatter::StampSplatter(const SplatInput& input, const SheetLayout& largest)
    : input_(input),
      blocks_(input, largest),
      sheet_(largest),
      weights_(input.footprint, largest.channels),
      mostBlocks_(blocks_.count()) {
    for (int n = 0; n < 64; ++n) {
        const std::size_t pixels = std::size_t(n >> 3) * largest.pitchPixels() + (n & 7);
        placeInBlock_[n] = std::uint32_t(pixels * largest.resolution);
    }
}

void StampSplatter::setLayout(const SheetLayout& layout) {
    blocks_.setLayout(layout);
    sheet_.setLayout(layout);
}

// Changes have to be added wherever they are, for what is not read now may be later.
void StampSplatter::splat(int slice, bool whole, int firstRow, int lastRow) {
    if (whole) {
        sheet_.clear();
    } else if (shown_.empty()) {
        shown_.resize(64 * mostBlocks_);
    }
    const ClassTable::Color* colors = input_.classes.colors.data();
    const SheetLayout& layout = sheet_.layout();
    const glm::ivec2 rows = whole ? blocksReaching(layout, firstRow, lastRow) : blocks_.rows();
    blocks_.forEach(
        slice, whole, rows, [&](glm::ivec2 block, std::uint64_t active, const DeltaWord& word) {
            sheet_.touchUnlessFull(blocks_.reachOf(block, active));
            const std::uint64_t gone = active & ~word.visible;
            if (!whole && gone != 0) sheet_.touch(blocks_.reachOf(block, gone));
            const std::size_t place = layout.stampPlace(layout.firstVoxel + 8 * block);
            const BlockSlice voxels{word.classes, active, placeInBlock_.data()};
            const StampTarget target{sheet_.pixels() + layout.channels * place, sheet_.pitch()};
            if (whole) {
                stampWhole(voxels, colors, weights_, target);
            } else {
                stampChanges(voxels, colors, &shown_[64 * blocks_.placeOf(block)], weights_,
                             target);
            }
        });
    sheet_.settle();
}

void StampSplatter::clear() {
    sheet_.clear();
    std::fill(shown_.begin(), shown_.end(), ClassIndex{kEmptySlot});
}

}  // namespace deltasplat
