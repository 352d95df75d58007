// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "volume/class_ramps.h"
#include "volume/code_blocks.h"
#include "volume/hold_slots.h"
#include "words/block_looks.h"
#include "words/class_reader.h"
#include "words/joined_tiles.h"
#include "words/mix_window.h"
#include "words/packed_deltas.h"
#include "words/value_mixer.h"
#include "words/word_collector.h"

namespace deltasplat {

class JoinedTileReader;
class MixedSight;
class SlotHolder;

/// How voxels become classes. Null: as they are.
struct PackTools {
    const ClassRamps* ramps = nullptr;  ///< of the map
    const SlotHolder* holder = nullptr;
    const ValueMixer* mixer = nullptr;
    const MixedSight* sight = nullptr;
    const CodeTree* codes = nullptr;  ///< that values are mixed from
    const CodeTree* uncut = nullptr;  ///< that gradients are taken of
    const MixMap* mixMap = nullptr;   ///< with a mixer, of the map
};

/// What a packer packs: columns of blocks (same u and v), slices in increasing order.
struct Columns {
    const CodeBlock* begin;
    const CodeBlock* end;
};

/// What of it: all blocks, of which it counts what is in their slices, or those of some slabs.
struct PackRange {
    SlabLayout layout;  ///< of slabs that there may be
    int firstBlock;
    int lastBlock;
    bool storesWords = true;
    /// Of the layout, which slabs are whole: words that these do not need are left out, but for
    /// those by which others are told from the slice behind. Empty: that is not known yet.
    std::span<const PlannedSlab> planned = {};
    /// Null: for any number of words. When it is spent, packers go on without.
    WordBudget* budget = nullptr;
};

/// Words that a block may make: its slices, and one behind it that takes away what it showed.
inline constexpr std::size_t kMostWordsOfBlock = 9;
/// What a word takes until it has its place, and where voxels have looks of their own besides.
inline constexpr double kBytesPerWord =
    sizeof(DeltaWord) + sizeof(PendingWord) + 64 * sizeof(ClassIndex);
inline constexpr double kLookBytesPerWord = 64 * sizeof(OwnLook);

bool choosesClasses(const PackOptions& options);

/// Makes the words of a run of columns, and counts what is in their slices. Not for several threads
/// at once; several packers are.
class ColumnPacker {
  public:
    /// @param options,slotMap  must outlive this
    ColumnPacker(const IndexBox& box, const PackOptions& options, const PackTools& tools,
                 std::span<const Slot> slotMap, const PackRange& range);

    /// @param room  memory for words that are not in order yet, which another packer may have used;
    ///              what is in it does not matter
    void run(const Columns& columns, std::vector<PackedColumns>& room);
    /// The same of a run of tiles whose slices are joined.
    void runJoined(const JoinedTiles& tiles, std::size_t run, std::vector<PackedColumns>& room);

    /// What it packed: of columns that are halved along u, the first halves and the second ones;
    /// of tiles, each row of columns.
    std::vector<PackedColumns>& rows() { return rows_; }
    const SlabPlanner& planner() const { return planner_; }

  private:
    struct Window {
        Window(const CodeTree& codes, int sliceAxis, bool alongSlicesOnly)
            : reader(codes, sliceAxis, alongSlicesOnly) {}
        MixWindowReader reader;
        MixWindow window;
    };
    using SliceClasses = std::array<ClassIndex, 64>;
    using BlockClasses = std::array<ClassIndex, 512>;
    void addJoined(JoinedTileReader& reader, const JoinedTile& tile);
    static void groupByColumn(std::vector<PendingWord>& words, std::size_t first);
    void begin(std::size_t rows, std::vector<PackedColumns>& room);
    void payForWords();
    void finish(std::vector<PackedColumns>& room);
    void dropUnneeded(std::vector<PendingWord>& words) const;
    bool mayBeWhole(int slice) const;
    static void sortParts(std::vector<PendingWord>& words, std::size_t first);
    bool isIn(const CodeBlock& block) const;
    void reserve(const Columns& columns);
    void reserveWords(PackedColumns& packed, std::size_t most);
    glm::ivec3 firstPart(const CodeBlock& block) const;
    glm::ivec3 partOf(const CodeBlock& block, int slices, const glm::ivec2& part) const;
    template <typename Use>
    void forParts(const Use& use) const;
    void read(const CodeBlock& block);
    void hold(const BlockSlots& slots, const glm::ivec3& position, const glm::ivec2& part,
              int number);
    void holdLooks(const BlockSlots& slots, const glm::ivec3& position, int number,
                   HeldSlots& before, BlockLooks::Slice& looksBefore);
    void addMixed(const CodeBlock& block);
    template <typename Use>
    void forMixed(const CodeBlock& block, const Use& use) const;
    void paintMixed(const CodeBlock& block);
    void keepSeen();
    void clearCutOff(const glm::ivec3& position);
    bool isAtEnd(const glm::ivec3& place) const;
    void closeEnds(const glm::ivec3& position);
    void add(const glm::ivec3& position, std::size_t number, std::size_t row, int slices);
    bool isNeeded(int slice, std::uint64_t visible, std::uint64_t changed) const;

    const PackOptions& options_;
    PackTools tools_;
    std::span<const Slot> slotMap_;
    IndexBox box_;
    SlabPlanner planner_;
    PackRange range_;
    Subdivision parts_;
    ClassReader classReader_;
    BlockClasses classes_{};            // of the block in hand, [slice][u][v]
    std::vector<SliceClasses> before_;  // [part, or column of a tile]: of the slice before it
    std::array<HeldSlots, 4> held_{};   // [part]
    BlockSlots slots_{};
    std::optional<Window> window_;
    std::optional<Window> uncut_;    // what was there before, if surfaces are cut
    std::vector<BlockSlots> mixed_;  // [part along u][along slices][along v]
    // Likewise, where classes are painted.
    struct PaintedBlock {
        std::array<ClassIndex, 512> classes;
        std::array<OwnLook, 512> looks;
    };
    std::vector<PaintedBlock> painted_;
    std::vector<PackedColumns> rows_;
    std::size_t paidWords_ = 0;        // of them
    std::unique_ptr<BlockLooks> own_;  // null: classes say all
    const CodeBlock* inHand_ = nullptr;
};

}  // namespace deltasplat
