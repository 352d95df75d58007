// SPDX-License-Identifier: Apache-2.0
#include "words/mix_window.h"

#include <algorithm>
#include <optional>

#include "volume/leaf_slices.h"

namespace deltasplat {

BlockFinder::BlockFinder(const CodeTree& codes, int sliceAxis)
    : blocks_(codes.blocksAlong(sliceAxis)), sliceAxis_(sliceAxis) {
    if (blocks_) {
        blocks_->blocks();  // makes missing blocks on all threads
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

bool MixWindow::isUniform() const {
    return std::all_of(slots.begin(), slots.end(), [&](Slot slot) { return slot == slots[0]; });
}

bool MixWindow::hasAnyAround(const glm::ivec3& place) const {
    for (int n = 0; n < 27; ++n) {
        if (at(place + glm::ivec3(n / 9, n / 3 % 3, n % 3) - 1) != kEmptySlot) return true;
    }
    return false;
}

MixWindowReader::MixWindowReader(const CodeTree& codes, int sliceAxis, bool alongSlicesOnly)
    : finder_(codes, sliceAxis), sliceAxis_(sliceAxis), reach_(alongSlicesOnly ? 0 : 1) {}

void MixWindowReader::read(const CodeBlock& block, MixWindow& window) const {
    for (int s = -1; s <= 1; ++s) {
        for (int u = -reach_; u <= reach_; ++u) {
            for (int v = -reach_; v <= reach_; ++v) {
                const glm::ivec3 side(s, u, v);
                if (side == glm::ivec3(0)) {
                    readPart(&block, side, window);
                } else {
                    const std::optional<CodeBlock> found = finder_.find(block.position + side);
                    readPart(found ? &*found : nullptr, side, window);
                }
            }
        }
    }
}

void MixWindowReader::read(const glm::ivec3& position, MixWindow& window) const {
    CodeBlock nothing;
    nothing.position = position;
    read(finder_.find(position).value_or(nothing), window);
}

// Reads the window's part of the block on one side (each component -1, 0 or 1).
void MixWindowReader::readPart(const CodeBlock* block, const glm::ivec3& side,
                               MixWindow& window) const {
    glm::ivec3 first, last;
    for (int i = 0; i < 3; ++i) {
        first[i] = side[i] < 0 ? 7 : 0;
        last[i] = side[i] > 0 ? 0 : 7;
    }
    if (block && block->slots) {
        for (int s = first.x; s <= last.x; ++s) {
            for (int u = first.y; u <= last.y; ++u) {
                const ShortSlot* row = block->slots + 64 * s + 8 * u;
                std::copy(row + first.z, row + last.z + 1,
                          &window.at(8 * side + glm::ivec3(s, u, first.z)));
            }
        }
        return;
    }
    const auto forAll = [&](const auto& slotOf) {
        forLeafVoxels(sliceAxis_, first, last, [&](const glm::ivec3& place, int n) {
            window.at(8 * side + place) = slotOf(n);
        });
    };
    const CodeTree::Leaf* leaf = block ? block->leaf : nullptr;
    if (!leaf) {
        const Slot slot = block ? block->tileSlot : kEmptySlot;
        return forAll([&](int) { return slot; });
    }
    const Code* codes = leaf->buffer().data();
    if (leaf->isDense()) return forAll([&](int n) { return codes[n] + 1; });
    forAll([&](int n) { return leaf->isValueOn(openvdb::Index(n)) ? codes[n] + 1 : kEmptySlot; });
}

}  // namespace deltasplat
