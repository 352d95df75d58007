// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/hold_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/sorting.h"
#include "formats/delta/block_windows.h"
#include "formats/readers.h"
#include "volume/code_blocks.h"
#include "volume/code_counts.h"
#include "volume/hold_slots.h"
#include "volume/leaf_slices.h"

namespace deltasplat {
namespace {

// Says which values stand for which, in terms of slots.
class HoldRule {
  public:
    HoldRule(const Volume& volume, const Tolerance& tolerance)
        : values_(kSlotCount), allowed_(kSlotCount, -1) {
        for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
            if (volume.histogram[code] == 0) continue;
            const double value = volume.codeBook.valueOf(Code(code));
            values_[code + 1] = value;
            const double codeError = volume.codeBook.largestErrorOf(Code(code)) * (1 + 1e-9);
            // What is empty, though active, stays empty, and nothing becomes so.
            const bool empty = volume.hasBackground && value == volume.background;
            if (empty) values_[code + 1] = std::numeric_limits<double>::infinity();
            allowed_[code + 1] = empty ? -1 : allowance(value, tolerance, codeError);
        }
    }

    bool holds(Slot held, Slot slot) const {
        if (held == slot || held == kEmptySlot || slot == kEmptySlot) return held == slot;
        return std::fabs(values_[std::size_t(held)] - values_[std::size_t(slot)]) <=
               allowed_[std::size_t(slot)];
    }

  private:
    // Of the code book's error the true value may be nearer to 0, and the code's farther off.
    static double allowance(double value, const Tolerance& tolerance, double codeError) {
        double allowed = std::numeric_limits<double>::infinity();
        if (tolerance.value > 0) allowed = tolerance.value;
        if (tolerance.relative > 0) {
            const double nearest = std::max(0.0, std::fabs(value) - codeError);
            allowed = std::min(allowed, tolerance.relative * nearest);
        }
        return allowed - codeError;
    }

    std::vector<double> values_;
    std::vector<double> allowed_;
};

// A block whose codes changed, and its new leaf.
struct Changed {
    openvdb::Coord origin;
    std::unique_ptr<CodeTree::Leaf> leaf;
};

// Holds values along one column of blocks (same u and v), in place where there are leaves.
class ColumnHolder {
  public:
    ColumnHolder(const BlockReader& reader, const SlabLayout& layout, const HoldRule& rule,
                 int sliceAxis)
        : reader_(reader), layout_(layout), rule_(rule), sliceAxis_(sliceAxis) {}

    void run(const CodeBlock* begin, const CodeBlock* end, std::vector<Changed>& changed) const {
        HeldSlots held{};
        BlockSlots slots;
        for (const CodeBlock* block = begin; block != end; ++block) {
            const bool goesOn = block != begin && follows(block[-1], *block);
            if (!goesOn || layout_.startsSlab(block->position.x)) held.fill(kEmptySlot);
            reader_.readBlock(*block, slots);
            if (hold(slots, held)) changed.push_back(replaced(*block, slots));
        }
    }

  private:
    // Returns whether any slot was replaced by the one held.
    bool hold(BlockSlots& slots, HeldSlots& held) const {
        bool any = false;
        const auto next = [&](Slot before, Slot slot) {
            return rule_.holds(before, slot) ? before : slot;
        };
        holdSlots(slots, held, next, [&](std::size_t i, Slot slot) {
            any |= slots[i] != slot;
            slots[i] = slot;
        });
        return any;
    }

    Changed replaced(const CodeBlock& block, const BlockSlots& slots) const {
        Changed changed{blockOrigin(block.position, sliceAxis_), nullptr};
        changed.leaf = block.leaf ? std::make_unique<CodeTree::Leaf>(*block.leaf)
                                  : std::make_unique<CodeTree::Leaf>(changed.origin, Code(0), true);
        Code* codes = changed.leaf->buffer().data();
        const Slot* slot = slots.data();
        forLeafVoxels(sliceAxis_, [&](const glm::ivec3&, int n) {
            // What is empty keeps its code.
            if (*slot != kEmptySlot) codes[n] = Code(*slot - 1);
            ++slot;
        });
        return changed;
    }

    const BlockReader& reader_;
    const SlabLayout& layout_;
    const HoldRule& rule_;
    int sliceAxis_;
};

}  // namespace

void holdValues(Volume& volume, int sliceAxis, int keyInterval, const Tolerance& tolerance,
                std::span<const Slot> slotMap) {
    if (volume.empty() || tolerance.isExact()) return;
    const SlabLayout layout = layoutOf(permutedBox(volume.box, sliceAxis), keyInterval);
    const BlockReader reader(*volume.codes, nullptr, sliceAxis, slotMap);
    const HoldRule rule(volume, tolerance);
    const ColumnHolder holder(reader, layout, rule, sliceAxis);
    requireMemory("tolerance", double(reader.blocks().size()) * (sizeof(Changed) + 1200));

    const std::vector<std::size_t> columns = runBegins(reader.blocks(), shareColumn);
    std::vector<std::vector<Changed>> changed(columns.size() - 1);
    parallelForChunks(changed.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const CodeBlock* blocks = reader.blocks().data();
            holder.run(blocks + columns[i], blocks + columns[i + 1], changed[i]);
        }
    });

    const auto codes = std::make_shared<CodeTree>(std::in_place, volume.codes->tree());
    openvdb::tree::ValueAccessor<CodeTree::Tree> accessor(codes->tree());
    for (auto& column : changed) {
        for (Changed& block : column) accessor.addLeaf(block.leaf.release());
    }
    volume.histogram = histogramOf(codes->tree());
    volume.codes = codes;
    summarize(volume);
}

}  // namespace deltasplat
