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

/// Which codes are seen, asked for whole ranges.
class SeenCodes {
  public:
    /// @param isSeen  isSeen(code) for 0 .. kCodeCount - 1
    template <typename IsSeen>
    explicit SeenCodes(const IsSeen& isSeen) : before_(std::size_t(kCodeCount) + 1) {
        for (int code = 0; code < kCodeCount; ++code)
            before_[std::size_t(code) + 1] = before_[std::size_t(code)] + (isSeen(code) ? 1 : 0);
    }
    /// Whether any of lowest .. highest is.
    bool hasAny(Code lowest, Code highest) const {
        return before_[std::size_t(highest) + 1] != before_[lowest];
    }

  private:
    std::vector<int> before_;  // [code]: how many before it are seen
};

class SeenCodes;

/// A slot in 16 bits: 0 = empty, else code + 1; for codes below 65535.
using ShortSlot = std::uint16_t;

/// An 8x8x8 block with active voxels.
struct SlotBlock {
    glm::ivec3 position{0};            ///< of its first voxel in (slice, u, v) order, divided by 8
    const ShortSlot* slots = nullptr;  ///< [slice][u][v]; null: all are `tileSlot`
    Slot tileSlot = kEmptySlot;
    Code lowest = 0;  ///< range of the active voxels' codes
    Code highest = 0;
};

/// The lowest and the highest of some codes; nothing if there are none.
using CodeRange = std::optional<std::pair<Code, Code>>;

/// Where the slots of blocks lie.
using SlotStorage = std::vector<std::unique_ptr<ShortSlot[]>>;

/// Makes blocks of a volume, in parts of which it is known beforehand which codes they have.
class BlockMaker {
  public:
    /// Blocks one behind the other along the slices.
    struct Part {
        glm::ivec3 first{0};  ///< place of the first, as SlotBlock::position
        Code lowest = 0;      ///< range of the active voxels' codes
        Code highest = 0;
    };

    /// What make() has made.
    struct Made {
        std::vector<SlotBlock> blocks;   ///< in the order of the parts
        std::vector<CodeRange> leftOut;  ///< of each part, the codes of the blocks left out
        SlotStorage storage;             ///< of the blocks' slots
    };

    BlockMaker() = default;
    BlockMaker(const BlockMaker&) = delete;
    BlockMaker& operator=(const BlockMaker&) = delete;
    virtual ~BlockMaker() = default;

    /// By u, then v, then slice; no block lies in two of them.
    virtual const std::vector<Part>& parts() const = 0;
    /// Makes the blocks of some parts, on all threads. One call at a time.
    /// @param parts  their numbers, in order
    /// @param seen   null, or leaves blocks out that have none of these codes
    /// @throw Error(kInput) if they are not what was known of them; Error(kFailed) if memory does
    ///        not hold them
    virtual Made make(std::span<const std::size_t> parts, const SeenCodes* seen) const = 0;
};

/// The codes of a volume as they lie along a slice axis: what words are made of, block by block,
/// without a tree. Blocks may be made when they are first asked for. Thread-safe.
class SlotBlocks {
  public:
    /// @param blocks   by u, then v, then slice; each has active voxels
    /// @param storage  what they point into
    SlotBlocks(int sliceAxis, std::vector<SlotBlock> blocks, SlotStorage storage);
    SlotBlocks(int sliceAxis, std::unique_ptr<const BlockMaker> maker);
    ~SlotBlocks();

    int sliceAxis() const { return sliceAxis_; }
    /// All blocks; what BlockMaker::make throws.
    const std::vector<SlotBlock>& blocks() const;
    /// Returns blocks in the same order, of which there are all that have codes which are seen.
    std::shared_ptr<const std::vector<SlotBlock>> blocksWith(const SeenCodes& seen) const;
    /// Returns a block by its position, or null if there is none.
    const SlotBlock* find(const glm::ivec3& position) const;
    /// Returns how much memory blocks take, without making any.
    std::size_t memoryBytes() const;

  private:
    // Blocks, and where columns of a rectangle of u and v begin among them.
    struct Columns;
    using Blocks = std::shared_ptr<const std::vector<SlotBlock>>;

    const Columns& all() const;
    void makeParts(const std::vector<std::size_t>& parts, const SeenCodes* seen) const;

    int sliceAxis_;
    mutable std::mutex mutex_;
    mutable SlotStorage storage_;
    mutable Blocks blocks_;                            // those made so far
    mutable std::unique_ptr<const BlockMaker> maker_;  // null once all are made
    mutable std::vector<bool> isMade_;                 // of its parts
    mutable std::vector<CodeRange> leftOut_;           // likewise, of blocks that are not made
    mutable std::unique_ptr<const Columns> columns_;
    mutable std::atomic<const Columns*> all_ = nullptr;  // null until all are made
};

}  // namespace deltasplat
