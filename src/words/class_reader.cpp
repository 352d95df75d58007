// SPDX-License-Identifier: Apache-2.0
#include "words/class_reader.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <type_traits>

#include "volume/block_kernels.h"
#include "volume/leaf_slices.h"

namespace deltasplat {

template <typename T>
void ClassReader::read(const CodeBlock& block, std::span<T, 512> out) const {
    if constexpr (std::is_same_v<T, ClassIndex>) {
        if (readRamp(block, out)) return;
    }
    const Slot* const map = slotMap_.data();
    if (block.slots) {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = T(map[block.slots[i]]);
    } else if (block.leaf) {
        const auto slotOf = [map](Code code) { return map[code + 1]; };
        readLeafSlices(*block.leaf, sliceAxis_, slotOf, out.data());
    } else {
        std::fill(out.begin(), out.end(), T(block.tileSlot));
    }
}

template void ClassReader::read(const CodeBlock&, std::span<ClassIndex, 512>) const;
template void ClassReader::read(const CodeBlock&, std::span<Slot, 512>) const;

// Does so by vectors if the map is a ramp over the codes of the block. Returns whether it is.
bool ClassReader::readRamp(const CodeBlock& block, std::span<ClassIndex, 512> out) const {
    if (!ramps_ || (!block.slots && !block.leaf)) return false;
    const std::optional<ClassRamp> ramp = ramps_->of(block.lowest, block.highest);
    if (!ramp) return false;
    if (block.slots) {
        classesOfSlots(*ramp, block.slots, out.data());
    } else {
        classesOfLeaf(*ramp, block.leaf->buffer().data(), sliceAxis_, out.data());
        clearInactiveSlices(*block.leaf, sliceAxis_, out.data());
    }
    return true;
}

}  // namespace deltasplat
