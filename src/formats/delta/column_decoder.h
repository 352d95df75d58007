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

/// The layout of a delta grid's blocks, in (slice, u, v) order.
class BlockLayout {
  public:
    explicit BlockLayout(const DeltaHeader& header);

    int slabs() const { return slabOf(lastBlock.x) + 1; }
    int slabOf(int block) const { return (block - firstBlock.x) / blocksPerSlab; }
    bool startsSlab(int block) const { return (block - firstBlock.x) % blocksPerSlab == 0; }
    /// Returns the first block behind the slab of `block`.
    int endOfSlab(int block) const { return blocksOf(slabOf(block)).y + 1; }
    /// Returns the first and the last block of a slab.
    glm::ivec2 blocksOf(int slab) const;
    /// Returns the number of columns in the box, with deltas or without.
    double columns() const;
    bool hasColumn(const glm::ivec2& place) const;
    bool hasSlice(int slice) const { return slice >= first.x && slice <= last.x; }
    /// Returns the voxels of a block's slice that are in the box, as a mask word.
    std::uint64_t insideOf(const glm::ivec2& place) const;
    /// Whether blocks with resting active voxels are few enough to list, if `changed` have deltas.
    bool canListRest(std::size_t changed) const;

    glm::ivec3 first, last;  ///< voxels of the box, inclusive
    glm::ivec3 firstBlock, lastBlock;
    int blocksPerSlab;
};

/// Returns the slots that a delta grid of codes may have.
SlotRules slotRulesOf(const DeltaHeader& header);

/// Returns the range of the active voxels' codes in blocks, or nothing without any.
CodeRange rangeOf(std::span<const SlotBlock> blocks);
CodeRange rangeOfBoth(const CodeRange& a, const CodeRange& b);

/// Returns the decoders' counts as Volume::histogram: of codes instead of slots.
std::vector<std::uint64_t> takeHistogram(CodeCounts& slots);

/// Adds up deltas to blocks, column by column. Not thread-safe.
class ColumnDecoder {
  public:
    /// Data shared by the decoders of all threads; outlives them.
    struct Grid {
        const DeltaHeader& header;
        const BlockLayout& layout;
        SlotRules rules;
        const std::string& where;  ///< for messages
        /// Null, or the codes that a block must have to be kept.
        const SeenCodes* seen = nullptr;
    };

    /// @param counts  null, or counts the slots of decoder number `worker`
    ColumnDecoder(std::unique_ptr<DeltaWalker> walker, const Grid& grid, CodeCounts* counts,
                  std::size_t worker);

    /// Adds a column's blocks that have active voxels. Returns whether the column is sound.
    /// @param range  first and last block of slices; the first begins a slab
    /// @throw Error(kFailed) if memory is too small
    bool decode(const DeltaColumn& column, const glm::ivec2& range, std::vector<SlotBlock>& blocks);

    /// Range of the codes of the last column's blocks that were left out.
    const CodeRange& leftOut() const { return leftOut_; }
    /// Number of deltas per slab so far.
    std::span<const std::uint64_t> slabDeltas() const { return slabDeltas_; }
    /// Box of the active voxels so far, in (slice, u, v) order, without resting voxels.
    const IndexBox& active() const { return active_; }
    /// Number of active voxels so far, left-out blocks included.
    std::uint64_t activeCount() const { return activeCount_; }
    SlotStorage& storage() { return storage_; }
    void dropSlots() {
        if (storage_.size() > 1) storage_.resize(1);
        used_ = 0;
    }

  private:
    static constexpr std::size_t kChunk = 64;  // blocks per allocation

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
    std::size_t used_ = 0;  // blocks in the last allocation

    // State of the current column.
    std::array<std::uint32_t, 64> slots_{};
    std::uint64_t inside_ = 0;
    CodeRange leftOut_;
};

}  // namespace deltasplat
