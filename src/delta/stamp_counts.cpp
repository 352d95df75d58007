// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/delta/stamp_counts.h"

namespace deltasplat {

StampCounts predictStamps(const Volume& volume, int sliceAxis, std::span<const Slot> slotMap) {
    StampCounts stamps;
    stamps.traditional = std::uint64_t(volume.box.voxels());
    for (const Slab& slab : planSlabs(volume, {sliceAxis, 0, Encoding::kSmaller, slotMap})) {
        stamps.sparse += slab.visible;
        stamps.delta += slab.deltas;
        stamps.automatic += slab.whole ? slab.visible : slab.deltas;
    }
    return stamps;
}

std::vector<Slot> slotsWithout(const CodeBook& codeBook, double value) {
    std::vector<Slot> slotMap(kSlotCount, kEmptySlot);
    for (int code = 0; code < kCodeCount; ++code) {
        if (!codeBook.standsFor(Code(code), value)) slotMap[code + 1] = code + 1;
    }
    return slotMap;
}

}  // namespace deltasplat
