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

// Reads by vectors if the map is a ramp over the block's codes. Returns whether it is.
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

namespace {

constexpr std::size_t kMostInTable = 512;

}  // namespace

SlotHolder::SlotHolder(const Volume& volume, const PackOptions& options) : options_(options) {
    std::vector<Slot> slots{kEmptySlot};
    for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
        const Slot slot = Slot(code + 1);
        if (volume.histogram()[code] != 0 && options.classOfSlot[slot] != kEmptySlot)
            slots.push_back(slot);
    }
    numberOf_.resize(kSlotCount);
    for (std::size_t i = 0; i < slots.size(); ++i) numberOf_[slots[i]] = Slot(i);
    for (const Slot slot : slots) classOf_.push_back(ClassIndex(options.classOfSlot[slot]));
    slots_ = std::move(slots);
    if (slots_.size() > kMostInTable) return;
    next_.resize(slots_.size() * slots_.size());
    for (std::size_t held = 0; held < slots_.size(); ++held) {
        for (std::size_t slot = 0; slot < slots_.size(); ++slot)
            next_[held * slots_.size() + slot] = std::uint16_t(ask(Slot(held), Slot(slot)));
    }
}

}  // namespace deltasplat
