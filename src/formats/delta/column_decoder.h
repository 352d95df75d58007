// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "formats/delta/delta_columns.h"
#include "formats/delta/leaf_kernels.h"
#include "volume/code_counts.h"
#include "volume/slot_blocks.h"

namespace deltasplat {

class SeenCodes;
struct DeltaHeader;

/// Where the blocks of a delta grid lie, in (slice, u, v) order.
class BlockLayout {
  public:
    explicit BlockLayout(const DeltaHeader& header);

    int slabs() const { return slabOf(lastBlock.x) + 1; }
    int slabOf(int block) const { return (block - firstBlock.x) / blocksPerSlab; }
    bool startsSlab(int block) const { return (block - firstBlock.x) % blocksPerSlab == 0; }
    /// Returns the first block behind the slab of one.
    int endOfSlab(int block) const { return blocksOf(slabOf(block)).y + 1; }
    /// Returns the first and the last block of a slab.
    glm::ivec2 blocksOf(int slab) const;
    /// How many columns the box has, with deltas or without.
    double columns() const;
    bool hasColumn(const glm::ivec2& place) const;
    bool hasSlice(int slice) const { return slice >= first.x && slice <= last.x; }
    /// Returns the voxels of a slice of a block that are in the box, as a mask word.
    std::uint64_t insideOf(const glm::ivec2& place) const;
    /// Whether all blocks can be listed where what rests is active.
    /// @param changed  how many have deltas
    bool canListRest(std::size_t changed) const;

    glm::ivec3 first, last;  ///< voxels of the box, inclusive
    glm::ivec3 firstBlock, lastBlock;
    int blocksPerSlab;
};

/// Returns which slots a delta grid of codes may have.
SlotRules slotRulesOf(const DeltaHeader& header);

/// Returns the range of the active voxels' codes in blocks; nothing if there are none.
CodeRange rangeOf(std::span<const SlotBlock> blocks);
/// Returns the range of the codes of both.
CodeRange rangeOfBoth(const CodeRange& a, const CodeRange& b);

/// Returns what decoders have counted, as Volume::histogram: of codes, not of slots.
std::vector<std::uint64_t> takeHistogram(CodeCounts& slots);

/// Adds up deltas to blocks, column by column. For one thread at a time.
class ColumnDecoder {
  public:
    /// What is common to those of all threads; outlives them.
    struct Grid {
        const DeltaHeader& header;
        const BlockLayout& layout;
        SlotRules rules;
        const std::string& where;  ///< for messages
        /// Null, or leaves blocks out that have none of these codes.
        const SeenCodes* seen = nullptr;
    };

    /// @param counts  null, or counts slots
    /// @param worker  of them
    ColumnDecoder(std::unique_ptr<DeltaWalker> walker, const Grid& grid, CodeCounts* counts,
                  std::size_t worker);

    /// Adds the blocks of a column that have active voxels; returns whether it is sound.
    /// @param range  first and last block of slices to be gone over; the first begins a slab
    /// @throw Error(kFailed) if memory does not hold them
    bool decode(const DeltaColumn& column, const glm::ivec2& range, std::vector<SlotBlock>& blocks);

    /// The codes of those blocks of the last column that were left out.
    const CodeRange& leftOut() const { return leftOut_; }
    /// How many deltas each slab had so far.
    std::span<const std::uint64_t> slabDeltas() const { return slabDeltas_; }
    /// The box of active voxels so far, in (slice, u, v) order; not of what rests.
    const IndexBox& active() const { return active_; }
    /// How many active voxels the blocks so far have, those left out too.
    std::uint64_t activeCount() const { return activeCount_; }
    /// What the blocks' slots lie in.
    SlotStorage& storage() { return storage_; }
    /// Forgets the slots of all blocks so far.
    void dropSlots() {
        if (storage_.size() > 1) storage_.resize(1);
        used_ = 0;
    }

  private:
    static constexpr std::size_t kChunk = 64;  // blocks whose slots are asked for at once

    bool isConstant() const;
    ShortSlot shown(std::uint32_t slot) const;
    bool decodeBlock(const glm::ivec3& position, const BlockDeltas* deltas,
                     std::vector<SlotBlock>& blocks);
    bool decodeAlike(glm::ivec3 position, int end, std::vector<SlotBlock>& blocks);
    bool addBlock(const glm::ivec3& position, const BlockDeltas& deltas, ShortSlot* out);
    bool writeSlice(const glm::ivec3& position, int s, ShortSlot* out) const;
    ShortSlot* room();
    bool addTile(const glm::ivec3& position, ShortSlot slot, std::vector<SlotBlock>& blocks);
    bool add(const SlotBlock& block, std::uint64_t active, std::vector<SlotBlock>& blocks);
    void extend(const glm::ivec3& position, const ShortSlot* out);
    bool contains(const glm::ivec3& position) const;
    void include(const glm::ivec3& position, const glm::ivec3& low, const glm::ivec3& high);

    std::unique_ptr<DeltaWalker> walker_;
    Grid grid_;
    CodeCounts* counts_;
    std::size_t worker_;
    std::vector<std::uint64_t> slabDeltas_;
    IndexBox active_;
    std::uint64_t activeCount_ = 0;
    SlotStorage storage_;
    std::size_t used_ = 0;  // blocks of the last of it

    // Of the column in hand.
    std::array<std::uint32_t, 64> slots_{};
    std::uint64_t inside_ = 0;
    CodeRange leftOut_;
};

}  // namespace deltasplat
