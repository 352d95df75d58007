// SPDX-License-Identifier: Apache-2.0
#include "rays/block_values.h"

#include <algorithm>
#include <bit>

#include "bit_matrix.h"

namespace deltasplat {
namespace {

ActiveWords allActive() {
    ActiveWords words;
    words.fill(~std::uint64_t{0});
    return words;
}

ActiveWords activeWords(const CodeTree::Leaf& leaf, int sliceAxis) {
    ActiveWords words{};
    const auto& mask = leaf.getValueMask();
    for (int x = 0; x < 8; ++x) {
        const auto word = mask.getWord<std::uint64_t>(x);  // bit 8 * y + z
        const std::uint64_t turned = sliceAxis == 2 ? transposedBits(word) : 0;
        for (int i = 0; i < 8; ++i) {
            if (sliceAxis == 1) words[i] |= (word >> (8 * i) & 0xFF) << (8 * x);  // bit 8 * x + z
            if (sliceAxis == 2) words[i] |= (turned >> (8 * i) & 0xFF) << (8 * x);
        }
        if (sliceAxis == 0) words[x] = word;
    }
    if (sliceAxis == 1) {
        for (std::uint64_t& word : words) word = transposedBits(word);
    }
    return words;
}

void clearInactive(const ActiveWords& words, float empty, const BlockPlace& place) {
    for (std::size_t slice = 0; slice < 8; ++slice) {
        for (std::uint64_t off = ~words[slice]; off != 0; off &= off - 1) {
            const auto bit = std::size_t(std::countr_zero(off));
            place.first[slice * place.sliceStep + bit / 8 * place.rowStep + bit % 8] = empty;
        }
    }
}

}  // namespace

ActiveWords readActiveValues(const RayVolume& volume, const CodeBlock& block,
                             const BlockPlace& place) {
    if (volume.sourceValues) {
        volume.sourceValues(block, place);
    } else if (block.leaf) {
        readBlockValues(block.leaf->buffer().data(), volume.sliceAxis, volume.values, place);
    } else {
        fillBlock(volume.valueOf(Code(block.tileSlot - 1)), place);
    }
    if (!block.leaf || block.leaf->isDense()) return allActive();
    const ActiveWords words = activeWords(*block.leaf, volume.sliceAxis);
    clearInactive(words, volume.empty, place);
    return words;
}

}  // namespace deltasplat
