// SPDX-License-Identifier: Apache-2.0
#include "splat/slice_blocks.h"

#include <algorithm>
#include <bit>

#include "hwy/cache_control.h"

namespace deltasplat {

SheetBox SliceBlocks::reachOf(glm::ivec2 block, std::uint64_t word) const {
    const int firstU = std::countr_zero(word) >> 3;
    const int lastU = (63 - std::countl_zero(word)) >> 3;
    word |= word >> 32;
    word |= word >> 16;
    word |= word >> 8;
    const auto columns = std::uint8_t(word);
    const int firstV = std::countr_zero(columns);
    const int lastV = 7 - std::countl_zero(columns);
    const int r = layout_.resolution;
    const glm::ivec2 origin = 8 * r * block + layout_.marginPixels - layout_.reachPixels;
    return {origin + r * glm::ivec2(firstV, firstU),
            origin + r * glm::ivec2(lastV, lastU) + layout_.footprintPixels - 1};
}

// The words of a slice in rows of blocks; they are ordered by u.
std::span<const DeltaWord> SliceBlocks::wordsOf(int slice, glm::ivec2 rows) const {
    const std::span<const DeltaWord> words = input_.deltas.slice(slice);
    const int firstU = layout_.firstVoxel.y / 8;
    const auto before = [](const DeltaWord& word, int u) { return word.block.x < u; };
    const auto first = std::lower_bound(words.begin(), words.end(), firstU + rows.x, before);
    return {first, std::lower_bound(first, words.end(), firstU + std::max(rows.x, rows.y), before)};
}

// Sheets run along v.
glm::ivec2 SliceBlocks::blockOf(const DeltaWord& word) const {
    return glm::ivec2(word.block.y, word.block.x) - layout_.firstVoxel / 8;
}

// Returns a mask word of the voxels of a block that lie in the volume's box.
std::uint64_t SliceBlocks::voxelsInBox(glm::ivec2 block) const {
    const IndexBox& box = input_.deltas.box;
    const glm::ivec2 first = layout_.firstVoxel + 8 * block;
    std::uint64_t word = 0;
    for (int n = 0; n < 64; ++n) {
        const int u = first.y + (n >> 3);
        const int v = first.x + (n & 7);
        const bool inside = u >= box.min.y && u <= box.max.y && v >= box.min.z && v <= box.max.z;
        word |= std::uint64_t{inside} << n;
    }
    return word;
}

// The words of a slice lie in order, but not what they point to.
void SliceBlocks::prefetchClasses(const DeltaWord* word, std::span<const DeltaWord> words) {
    constexpr std::ptrdiff_t kAhead = 8;
    if (words.data() + words.size() - word <= kAhead) return;
    hwy::Prefetch(word[kAhead].classes);
    hwy::Prefetch(word[kAhead].classes + 32);
}

}  // namespace deltasplat
