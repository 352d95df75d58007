// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/ingest/slot.h"

namespace deltasplat {

/// The codes that are seen, with fast queries for ranges.
class SeenCodes {
  public:
    /// @param isSeen  isSeen(code) for 0 .. kCodeCount - 1
    template <typename IsSeen>
    explicit SeenCodes(const IsSeen& isSeen) : before_(std::size_t(kCodeCount) + 1) {
        for (int code = 0; code < kCodeCount; ++code)
            before_[std::size_t(code) + 1] = before_[std::size_t(code)] + (isSeen(code) ? 1 : 0);
    }
    /// Whether any code in lowest .. highest is seen.
    bool hasAny(Code lowest, Code highest) const {
        return before_[std::size_t(highest) + 1] != before_[lowest];
    }

  private:
    std::vector<int> before_;  // [code]: number of seen codes before it
};

class SeenCodes;

/// A slot in 16 bits: 0 = empty, else code + 1. Only for codes below 65535.
using ShortSlot = std::uint16_t;

struct SlotBlock {
    glm::ivec3 position{0};            ///< of its first voxel in (slice, u, v) order, divided by 8
    const ShortSlot* slots = nullptr;  ///< [slice][u][v]; null: all are `tileSlot`
    Slot tileSlot = kEmptySlot;
    Code lowest = 0;  ///< range of the active voxels' codes
    Code highest = 0;
};

/// Lowest and highest code of a set; nothing if the set is empty.
using CodeRange = std::optional<std::pair<Code, Code>>;

using SlotStorage = std::vector<std::unique_ptr<ShortSlot[]>>;

/// Makes the blocks of a volume in parts. The codes of a part are known before its blocks are made.
class BlockMaker {
  public:
    /// Consecutive blocks along the slices.
    struct Part {
        glm::ivec3 first{0};  ///< position of the first block
        Code lowest = 0;      ///< range of the active voxels' codes
        Code highest = 0;
    };

    struct Made {
        std::vector<SlotBlock> blocks;   ///< in the order of the parts
        std::vector<CodeRange> leftOut;  ///< per part, the codes of the blocks left out
        SlotStorage storage;             ///< of the blocks' slots
    };

    BlockMaker() = default;
    BlockMaker(const BlockMaker&) = delete;
    BlockMaker& operator=(const BlockMaker&) = delete;
    virtual ~BlockMaker() = default;

    /// Ordered by u, then v, then slice. Each block lies in one part only.
    virtual const std::vector<Part>& parts() const = 0;
    /// Makes the blocks of some parts, on all threads. One call at a time.
    /// @param parts  indices into parts(), in increasing order
    /// @param seen   null, or blocks without any of these codes are left out
    /// @throw Error(kInput) if blocks contradict what was known; Error(kFailed) if out of memory
    virtual Made make(std::span<const std::size_t> parts, const SeenCodes* seen) const = 0;
};

/// The codes of a volume along a slice axis; words need no tree. Made on first use. Thread-safe.
class SlotBlocks {
  public:
    /// @param blocks   by u, then v, then slice; each has active voxels
    /// @param storage  slots that the blocks point into
    SlotBlocks(int sliceAxis, std::vector<SlotBlock> blocks, SlotStorage storage);
    SlotBlocks(int sliceAxis, std::unique_ptr<const BlockMaker> maker);
    ~SlotBlocks();

    int sliceAxis() const { return sliceAxis_; }
    /// All blocks. Throws as BlockMaker::make does.
    const std::vector<SlotBlock>& blocks() const;
    /// Returns blocks in the same order, at least all that have seen codes.
    std::shared_ptr<const std::vector<SlotBlock>> blocksWith(const SeenCodes& seen) const;
    const SlotBlock* find(const glm::ivec3& position) const;
    /// Returns the bytes of the blocks made so far.
    std::size_t memoryBytes() const;

  private:
    // Blocks, and an index of the columns in a rectangle of u and v.
    struct Columns;
    using Blocks = std::shared_ptr<const std::vector<SlotBlock>>;

    const Columns& all() const;
    void makeParts(const std::vector<std::size_t>& parts, const SeenCodes* seen) const;

    int sliceAxis_;
    mutable std::mutex mutex_;
    mutable SlotStorage storage_;
    mutable Blocks blocks_;                            // made so far
    mutable std::unique_ptr<const BlockMaker> maker_;  // null once all blocks are made
    mutable std::vector<bool> isMade_;                 // [part]
    mutable std::vector<CodeRange> leftOut_;  // [part]: codes of the blocks that are not made
    mutable std::unique_ptr<const Columns> columns_;
    mutable std::atomic<const Columns*> all_ = nullptr;  // null until all blocks are made
};

}  // namespace deltasplat
