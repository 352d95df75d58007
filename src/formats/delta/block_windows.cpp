// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/block_windows.h"

#include <algorithm>

#include "base/parallel.h"
#include "volume/block_kernels.h"

namespace deltasplat {

BlockWindows::BlockWindows(const BlockReader& reader, const SlabLayout& layout)
    : reader_(reader), layout_(layout) {
    const std::vector<CodeBlock>& blocks = reader.blocks();
    places_.reserve(blocks.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        places_.push_back({i, false});
        const int next = blocks[i].position.x + 1;
        const bool ends = next <= layout.lastBlock && !layout.startsSlab(next);
        if (ends && !continues(i + 1)) places_.push_back({i, true});
    }
}

bool BlockWindows::continues(std::size_t i) const {
    const std::vector<CodeBlock>& blocks = reader_.blocks();
    return i > 0 && i < blocks.size() && follows(blocks[i - 1], blocks[i]) &&
           !layout_.startsSlab(blocks[i].position.x);
}

void BlockWindows::read(std::size_t i, BlockWindow& window) const {
    const Place place = places_[i];
    const std::vector<CodeBlock>& blocks = reader_.blocks();
    if (place.behind) {
        reader_.readLastSlice(blocks[place.block], window.before);
        window.slots.fill(kEmptySlot);
        return;
    }
    if (continues(place.block)) {
        reader_.readLastSlice(blocks[place.block - 1], window.before);
    } else {
        window.before.fill(kEmptySlot);
    }
    reader_.readBlock(blocks[place.block], window.slots);
}

std::vector<BlockChanges> findChanges(const BlockWindows& windows, const SlabLayout& layout) {
    static constexpr std::array<Slot, 64> kEmptySlice{};
    std::vector<BlockChanges> changes(windows.count());
    parallelForChunks(windows.count(), [&](std::size_t begin, std::size_t end) {
        BlockWindow window;
        for (std::size_t i = begin; i < end; ++i) {
            windows.read(i, window);
            for (int s = 0; s < layout.slicesOf(windows.position(i).x); ++s) {
                changes[i].visible[s] = differingSlots(window.slice(s), kEmptySlice.data());
                changes[i].changed[s] = differingSlots(window.slice(s), window.sliceBefore(s));
            }
        }
    });
    return changes;
}

}  // namespace deltasplat
