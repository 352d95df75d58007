// SPDX-License-Identifier: Apache-2.0
#include "words/slot_holder.h"

namespace deltasplat {
namespace {

constexpr std::size_t kMostInTable = 512;

}  // namespace

SlotHolder::SlotHolder(const Volume& volume, const PackOptions& options) : options_(options) {
    std::vector<Slot> slots{kEmptySlot};
    for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
        const Slot slot = Slot(code + 1);
        if (volume.histogram[code] != 0 && options.classOfSlot[slot] != kEmptySlot)
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
