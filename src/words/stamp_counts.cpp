// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/delta/stamp_counts.h"

#include "formats/delta/block_windows.h"
#include "volume/box_voxels.h"
#include "words/slab_plan.h"

namespace deltasplat {

StampCounts predictStamps(const Volume& volume, int sliceAxis, std::span<const Slot> slotMap) {
    StampCounts stamps;
    if (volume.empty()) return stamps;
    stamps.traditional = voxelsOf(volume.box);
    const IndexBox box = permutedBox(volume.box, sliceAxis);
    const SlabLayout layout = oneSlab(box);
    const BlockReader reader(*volume.codes, nullptr, sliceAxis, slotMap);
    const BlockWindows windows(reader, layout);
    const std::vector<BlockChanges> changes = findChanges(windows, layout);
    SlabPlanner planner(box);
    for (std::size_t i = 0; i < changes.size(); ++i) {
        const int block = windows.position(i).x;
        const auto slices = std::size_t(layout.slicesOf(block));
        planner.add(8 * block, std::span(changes[i].visible).first(slices),
                    std::span(changes[i].changed).first(slices));
    }
    for (const PlannedSlab& slab : planner.plan(Encoding::kFewerWordsOrWrites).slabs) {
        stamps.sparse += slab.visible;
        stamps.delta += slab.deltas;
        stamps.automatic += slab.stamps();
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
