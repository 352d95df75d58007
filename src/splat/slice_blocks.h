// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <glm/vec2.hpp>
#include <memory_resource>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "deltasplat/splat/footprint.h"
#include "hwy/cache_control.h"
#include "splat/digit_voxels.h"
#include "splat/sheet.h"
#include "splat/sheet_cover.h"
#include "splat/word_colors.h"
#include "words/packed_deltas.h"

namespace deltasplat {

/// A slice's words with own colours, lit on request, kept until the next. Not thread-safe.
class LitSlice {
  public:
    /// @param colors  must outlive this, as `deltas`
    LitSlice(const PackedDeltas& deltas, const WordColors& colors)
        : deltas_(deltas), colors_(colors) {}

    void begin(int slice);
    /// Returns the look of a word on a plane; valid until the next slice.
    /// @param word  of the slice, numbered among all words
    const LitWord& of(std::size_t word, int plane);

    /// Most bytes for a slice of this many words.
    static double bytes(double words, int planes) { return sizeof(LitWord) * words * planes; }

  private:
    static constexpr std::uint32_t kUnlit = 0xFFFFFFFF;

    const PackedDeltas& deltas_;
    const WordColors& colors_;
    int slice_ = 0;
    bool hasSlice_ = false;
    std::size_t first_ = 0;               // first word of the slice
    std::vector<std::uint32_t> placeOf_;  // [words of the slice]: in lit_, or kUnlit
    std::deque<LitWord> lit_;             // [lit words][planes]; deques move nothing
    std::size_t used_ = 0;
};

/// Unchanging input of splatting slabs.
struct SplatInput {
    const PackedDeltas& deltas;
    const StepColors& colors;
    const Footprint& footprint;
    /// Which voxels have which digits; null with one digit, and with own colours.
    const DigitVoxels* digitVoxels;
    /// Stamp every voxel of the box, even empty ones (method `traditional`), in whole slabs.
    bool stampEmptyVoxels;
    /// For sheets and splatters.
    std::pmr::memory_resource& memory = *std::pmr::get_default_resource();
    /// Own colours of a thread's current slice, made by Splatter. Null: no own colours.
    LitSlice* lit = nullptr;
};

/// A block's slice as stamped for one digit of colours.
struct SeenWord {
    std::uint64_t visible;      ///< mask word of visible voxels
    std::uint64_t changed;      ///< as DeltaWord::changed
    const ClassIndex* classes;  ///< [64]: places in `colors`
    const ClassTable::Color* colors;
    bool hasOwn;  ///< whether colours are only this word's, in the order of voxels
    /// If the low digit goes with the high one: its colours, and the voxels that have it if known
    /// (SplatInput::digitVoxels, own colours). Else none.
    std::uint64_t lowVoxels = 0;
    const ClassTable::Color* lowColors = nullptr;
};

/// The blocks of slices that make up a sheet, or a part of it, of a digit.
class SliceBlocks {
  public:
    /// @param withLow  whether the low digit, which must exist, goes with this high one
    SliceBlocks(const SplatInput& input, const SheetLayout& layout, DigitPlace digit = {},
                bool withLow = false);

    void setLayout(const SheetLayout& layout) {
        layout_ = layout;
        firstBlock_ = layout.firstVoxel / 8;
    }
    const SheetLayout& layout() const { return layout_; }

    /// Calls `use(block, voxels, word)` for blocks (v, u) of a slice that reach needed pixels and
    /// have something to stamp: a mask word, and the SeenWord, as far as the digit goes.
    template <typename Use>
    void forWhole(int slice, const NeededPixels& needed, const Use& use) {
        forWords(slice, true, needed, use);
    }
    /// Calls `use` for changes since the previous slice, in slabs that are not whole, for all
    /// slices in order. Changes of blocks not yet needed wait: each word knows all voxels of its
    /// block, so the last one suffices. Own colours never wait, because they belong to one slice.
    template <typename Use>
    void forChanges(int slice, const NeededPixels& needed, const Use& use);
    /// Returns the look of a block of empty voxels.
    SeenWord nothingSeen() const {
        return {0, 0, kEmptyClasses.data(), colors_, false, 0, lowColors_};
    }
    void clear();
    /// Bytes kept per block: waiting changes, and the result of changes.
    static constexpr std::size_t kBytesOfBlock = 5 * sizeof(std::uint64_t);
    std::size_t count() const { return std::size_t(layout_.blocks.x) * layout_.blocks.y; }
    /// Returns a block's place in an array of count().
    std::size_t placeOf(glm::ivec2 block) const {
        return std::size_t(block.y) * layout_.blocks.x + block.x;
    }

  private:
    // Changes of a block that were not passed on yet.
    struct Waiting {
        std::uint64_t voxels = 0;
        std::uint64_t visible = 0;
        std::uint64_t lowVoxels = 0;
        const ClassIndex* classes = nullptr;  // after the changes
    };

    // Words tested for cover at once.
    static constexpr std::size_t kLookedAt = 16;
    // Words prefetched at once.
    static constexpr std::size_t kFetched = 8;

    template <typename Use>
    void forWords(int slice, bool whole, const NeededPixels& needed, const Use& use);
    template <typename Use>
    void forEachBlock(std::span<const DeltaWord> words, glm::ivec2 rows, const SheetCover* cover,
                      const Use& use) const;
    std::span<const DeltaWord> wordsOf(int slice, glm::ivec2 rows) const;
    // Sheets run along v.
    glm::ivec2 blockOf(const DeltaWord& word) const {
        return glm::ivec2(word.block.y, word.block.x) - firstBlock_;
    }
    // wordsOf() finds the rows.
    bool hasColumn(glm::ivec2 block) const { return block.x >= 0 && block.x < layout_.blocks.x; }
    SeenWord seenOf(const DeltaWord& word) const {
        if (input_.lit) return litOf(word);
        return {word.visible, word.changed,      word.classes, colors_,
                false,        lowVoxelsOf(word), lowColors_};
    }
    SeenWord litOf(const DeltaWord& word) const;
    std::uint64_t voxelsOfDigit(const DeltaWord& word) const;
    std::uint64_t lowVoxelsOf(const DeltaWord& word) const;
    void takeDigit(const DeltaWord& word, bool whole, SeenWord& seen);
    std::size_t numberOf(const DeltaWord& word) const {
        return std::size_t(&word - input_.deltas.words.data());
    }
    std::uint64_t voxelsInBox(glm::ivec2 block) const;
    bool hidesAll(const SheetCover::Row& row, std::span<const DeltaWord> words) const;
    static void fetchClasses(const DeltaWord& word) {
        hwy::Prefetch(word.classes);
        hwy::Prefetch(word.classes + 32);
    }

    const SplatInput& input_;
    SheetLayout layout_;
    glm::ivec2 firstBlock_;
    // Empty voxels are stamped once.
    bool stampEmptyVoxels_;
    DigitPlace digit_;
    const ClassTable::Color* colors_;  // of classes
    bool takesDigit_;                  // some visible voxels lack the digit
    // [word]: voxels of classes with the digit; null: all visible ones
    const std::uint64_t* voxels_ = nullptr;
    // Null where no low digit goes along.
    const ClassTable::Color* lowColors_ = nullptr;
    const std::uint64_t* lowVoxels_ = nullptr;
    std::vector<std::uint64_t> shown_;  // [block]: visible after the changes
    std::vector<Waiting> waiting_;      // [block]
    glm::ivec2 rowsBefore_{0};          // rows of blocks needed in the previous slice
};

// Changes come in order, and are skipped only where no later slice needs the block either.
template <typename Use>
void SliceBlocks::forWords(int slice, bool whole, const NeededPixels& needed, const Use& use) {
    const glm::ivec2 now = blocksReaching(layout_, needed.firstRow, needed.lastRow);
    const glm::ivec2 rows =
        whole ? now : blocksReaching(layout_, needed.rowsFromNowOn.x, needed.rowsFromNowOn.y);
    const SheetCover* cover = whole ? needed.cover : needed.fromNowOn;
    const std::span<const DeltaWord> words = wordsOf(slice, rows);
    if (input_.lit) input_.lit->begin(slice);
    if (stampEmptyVoxels_) return forEachBlock(words, rows, cover, use);
    const auto useWord = [&](const DeltaWord& word) {
        SeenWord seen = seenOf(word);
        if (takesDigit_) takeDigit(word, whole, seen);
        const std::uint64_t voxels = whole ? seen.visible : seen.changed;
        if (voxels != 0) use(blockOf(word), voxels, seen);
    };
    // Next words, whose classes are being prefetched.
    std::array<const DeltaWord*, kFetched> next;
    std::size_t count = 0;
    std::size_t looked = 0;
    int row = -1;
    std::optional<SheetCover::Row> hiding;  // of the current row
    bool fetches = false;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const DeltaWord& word = words[i];
        const glm::ivec2 block = blockOf(word);
        if (block.y != row) {
            row = block.y;
            if (cover) hiding = cover->blockRow(row);
            fetches = !input_.lit && row >= now.x && row < now.y;
        }
        if (hiding && i == looked) {
            looked = std::min(i + kLookedAt, words.size());
            if (hidesAll(*hiding, words.subspan(i, looked - i))) {
                i = looked - 1;
                continue;
            }
        }
        if (!hasColumn(block) || (hiding && hiding->hides(block.x))) continue;
        if (fetches) fetchClasses(word);
        const DeltaWord*& place = next[count++ % next.size()];
        if (count > next.size()) useWord(*place);
        place = &word;
    }
    for (std::size_t i = count - std::min(count, next.size()); i < count; ++i)
        useWord(*next[i % next.size()]);
}

// All blocks of rows, with their voxels in the volume's box.
template <typename Use>
void SliceBlocks::forEachBlock(std::span<const DeltaWord> words, glm::ivec2 rows,
                               const SheetCover* cover, const Use& use) const {
    const SeenWord nothing = nothingSeen();
    auto word = words.begin();
    for (int u = rows.x; u < rows.y; ++u) {
        std::optional<SheetCover::Row> hiding;
        if (cover) hiding = cover->blockRow(u);
        for (int v = 0; v < layout_.blocks.x; ++v) {
            while (word != words.end() && !hasColumn(blockOf(*word))) ++word;
            const bool has = word != words.end() && blockOf(*word) == glm::ivec2(v, u);
            if (!hiding || !hiding->hides(v))
                use(glm::ivec2(v, u), voxelsInBox({v, u}), has ? seenOf(*word) : nothing);
            if (has) ++word;
        }
    }
}

template <typename Use>
void SliceBlocks::forChanges(int slice, const NeededPixels& needed, const Use& use) {
    if (waiting_.size() < count()) waiting_.resize(count());
    const glm::ivec2 rows = blocksReaching(layout_, needed.firstRow, needed.lastRow);
    forWords(
        slice, false, needed, [&](glm::ivec2 block, std::uint64_t changed, const SeenWord& word) {
            Waiting& waiting = waiting_[placeOf(block)];
            if (word.hasOwn || (block.y >= rows.x && block.y < rows.y)) {
                use(block, std::exchange(waiting.voxels, 0) | changed, word);
            } else {
                waiting = {waiting.voxels | changed, word.visible, word.lowVoxels, word.classes};
            }
        });
    const auto enter = [&](int first, int last) {
        for (int u = first; u < last; ++u) {
            for (int v = 0; v < layout_.blocks.x; ++v) {
                Waiting& waiting = waiting_[placeOf({v, u})];
                if (waiting.voxels == 0) continue;
                const std::uint64_t changed = std::exchange(waiting.voxels, 0);
                use(glm::ivec2(v, u), changed,
                    SeenWord{waiting.visible, changed, waiting.classes, colors_, false,
                             waiting.lowVoxels, lowColors_});
            }
        }
    };
    enter(rows.x, std::min(rows.y, rowsBefore_.x));
    enter(std::max(rows.x, rowsBefore_.y), rows.y);
    rowsBefore_ = rows;
}

/// Makes sheets of one-pixel footprints: writes colours, both digits at once, to own pixels.
class PixelSplatter {
  public:
    static bool fits(const Footprint& footprint) { return footprint.width == 1; }

    /// Bytes for a footprint that fits, without the sheet.
    static double bytes(const SplatInput& input, const SheetLayout& layout);

    /// @param input    with a footprint that fits
    /// @param largest  of all layouts to come
    /// @param sheet    of that layout; zero whenever a slab begins
    /// @param withLow  whether the low digit, which must exist, is added to this high one
    PixelSplatter(const SplatInput& input, const SheetLayout& largest, Sheet& sheet,
                  DigitPlace digit, bool withLow);

    /// The sheet must have the layout already.
    void setLayout(const SheetLayout& layout) { blocks_.setLayout(layout); }
    /// Turns the sheet into the slice's, from that of the previous slice unless it is whole.
    /// @param needed  pixels that will be read; others are made once needed
    void splat(int slice, bool whole, const NeededPixels& needed);
    void clear();

  private:
    using Pixel = std::array<std::int32_t, 4>;

    void splatWhole(int slice, const NeededPixels& needed);
    void splatChanges(int slice, const NeededPixels& needed);
    template <typename Use>
    void withValues(const SeenWord& word, const Use& use);
    // Values of a block.
    template <typename Value>
    void writeVoxels(std::int32_t* tile, std::uint64_t voxels, const ClassIndex* classes,
                     const Value* values) const;
    template <typename Value>
    void writeRows(std::int32_t* tile, unsigned rows, const ClassIndex* classes,
                   const Value* values) const;
    Pixel pixelOf(const ClassTable::Color& high, const ClassTable::Color* low) const;

    SliceBlocks blocks_;
    Sheet& sheet_;
    std::int32_t one_;  // sum of a footprint
    // [class]: pixels_ for four channels, opacities_ for one.
    std::vector<Pixel> pixels_;
    std::vector<std::int32_t> opacities_;
    std::array<Pixel, 64> own_;            // of a word with own colours
    std::vector<int> slices_;              // [block]: last slice written, in whole slabs
    std::vector<glm::ivec2> shownBlocks_;  // in the current slice of a whole slab
    std::vector<glm::ivec2> before_;       // in the previous slice
};

}  // namespace deltasplat
