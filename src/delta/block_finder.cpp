// SPDX-License-Identifier: Apache-2.0
#include "delta/block_finder.h"

#include "ingest/codes/leaf_slices.h"

namespace deltasplat {

BlockFinder::BlockFinder(const CodeTree& codes, int sliceAxis)
    : blocks_(codes.blocksAlong(sliceAxis)), sliceAxis_(sliceAxis) {
    if (blocks_) {
        blocks_->blocks();  // those that are not made yet are made by all threads
    } else {
        accessor_.emplace(codes.tree());
    }
}

std::optional<CodeBlock> BlockFinder::find(const glm::ivec3& position) const {
    if (blocks_) {
        const SlotBlock* const block = blocks_->find(position);
        if (!block) return std::nullopt;
        return CodeBlock{position,      nullptr,        block->tileSlot, nullptr,
                         block->lowest, block->highest, block->slots};
    }
    const openvdb::Coord origin = blockOrigin(position, sliceAxis_);
    CodeBlock found;
    found.position = position;
    found.leaf = accessor_->probeConstLeaf(origin);
    if (found.leaf) return found.leaf->isEmpty() ? std::nullopt : std::optional(found);
    Code code;
    if (!accessor_->probeValue(origin, code)) return std::nullopt;
    found.tileSlot = Slot(code + 1);
    return found;
}

}  // namespace deltasplat
