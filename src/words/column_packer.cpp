// SPDX-License-Identifier: Apache-2.0
#include "words/column_packer.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>
#include <utility>

#include "volume/block_kernels.h"
#include "volume/code_blocks.h"
#include "words/joined_tiles.h"
#include "words/mixed_sight.h"
#include "words/slot_holder.h"

namespace deltasplat {
namespace {

// The number of a part of a column.
std::size_t numberOf(const glm::ivec2& part) {
    const int number = 2 * part.x + part.y;
    return std::size_t(number);
}

// Brings the codes of the next block nearer, and the leaf of the one behind it.
void fetchAhead(const CodeBlock* next, const CodeBlock* end) {
    if (next == end) return;
    if (next + 1 < end) hwy::Prefetch(next[1].leaf);
    if (next->leaf) fetchCodes(*next->leaf);
}

// Takes all words out, and keeps their memory.
void clear(PackedColumns& packed) {
    packed.words.clear();
    packed.storage.clear();
    packed.looks.clear();
}

}  // namespace

bool choosesClasses(const PackOptions& options) {
    return options.painter && options.painter->choosesClasses();
}

ColumnPacker::ColumnPacker(const IndexBox& box, const PackOptions& options, const PackTools& tools,
                           std::span<const Slot> slotMap, const PackRange& range)
    : options_(options),
      tools_(tools),
      slotMap_(slotMap),
      box_(box),
      planner_(box),
      range_(range),
      classReader_(slotMap, tools.ramps, options.sliceAxis),
      before_(options.joiner ? JoinedTileReader::kColumns : 4) {
    if (!tools.mixer) return;
    parts_ = tools.mixer->parts();
    window_.emplace(*tools.codes, options.sliceAxis,
                    parts_.within == 1 && !choosesClasses(options));
    if (choosesClasses(options) && tools.uncut != tools.codes)
        uncut_.emplace(*tools.uncut, options.sliceAxis, false);
    const int blocks = parts_.voxels();
    mixed_.resize(std::size_t(blocks));
}

// Calls use(part) for the parts of a column along u and v.
template <typename Use>
void ColumnPacker::forParts(const Use& use) const {
    for (int u = 0; u < parts_.within; ++u)
        for (int v = 0; v < parts_.within; ++v) use(glm::ivec2(u, v));
}

void ColumnPacker::run(const Columns& columns, std::vector<PackedColumns>& room) {
    begin(std::size_t(parts_.within), room);
    reserve(columns);
    if (options_.painter) {
        own_ = std::make_unique<BlockLooks>(*options_.painter, *tools_.uncut, options_.sliceAxis,
                                            parts_, box_);
    }
    std::array<std::size_t, 2> firstWord{};  // [half]: of the column
    for (const CodeBlock* block = columns.begin; block != columns.end; ++block) {
        if (!isIn(*block)) continue;
        if (own_) own_->beginBlock(*block);
        const bool isFirst =
            block == columns.begin || !follows(block[-1], *block) || !isIn(block[-1]);
        const bool isLast = block + 1 == columns.end || !follows(*block, block[1]);
        if (isFirst) {
            std::fill(before_.begin(), before_.end(), SliceClasses{});
            held_ = {};
            if (own_) own_->beginColumn();
            for (std::size_t half = 0; half < rows_.size(); ++half)
                firstWord[half] = rows_[half].words.size();
        }
        if (tools_.mixer) {
            addMixed(*block);
        } else {
            fetchAhead(block + 1, columns.end);
            read(*block);
            add(block->position, 0, 0, range_.layout.slicesOf(block->position.x));
        }
        // What a block showed must be taken away behind it.
        const int next = firstPart(*block).x + parts_.slices;
        const int last = tools_.mixer ? range_.layout.lastBlock : range_.lastBlock;
        if (!isLast) continue;
        if (next <= last) {
            classes_.fill(kEmptySlot);
            forParts([&](const glm::ivec2& part) {
                add(partOf(*block, next, part), numberOf(part), std::size_t(part.x), 1);
            });
        }
        payForWords();
        if (parts_.within == 1) continue;
        for (std::size_t half = 0; half < rows_.size(); ++half)
            sortParts(rows_[half].words, firstWord[half]);
    }
    own_.reset();
    painted_ = {};
    finish(room);
}

void ColumnPacker::runJoined(const JoinedTiles& tiles, std::size_t run,
                             std::vector<PackedColumns>& room) {
    begin(std::size_t(tiles.columns().x), room);
    std::vector<TileSources> sources;
    for (const JoinedTile& tile : tiles.runs()[run]) sources.push_back(tiles.sourcesOf(tile));
    payForWords();
    for (std::size_t u = 0; range_.storesWords && u < rows_.size(); ++u) {
        std::size_t blocks = 0;
        for (const TileSources& ofTile : sources)
            blocks += tiles.mostBlocks(ofTile, int(u), range_.firstBlock, range_.lastBlock);
        reserveWords(rows_[u], kMostWordsOfBlock * blocks);
    }
    JoinedTileReader reader(classReader_, *options_.joiner, tiles);
    for (std::size_t i = 0; i < sources.size(); ++i) {
        reader.begin(sources[i], range_.firstBlock, range_.lastBlock);
        addJoined(reader, tiles.runs()[run][i]);
        payForWords();
    }
    finish(room);
}

void ColumnPacker::begin(std::size_t rows, std::vector<PackedColumns>& room) {
    rows_ = std::move(room);
    rows_.resize(rows);
    std::for_each(rows_.begin(), rows_.end(), clear);
}

// Where all packers have more words than they may, there are to be none.
void ColumnPacker::payForWords() {
    if (!range_.budget || !range_.storesWords) return;
    std::size_t words = 0;
    for (const PackedColumns& packed : rows_) words += packed.words.size();
    if (range_.budget->take(words - std::exchange(paidWords_, words))) return;
    range_.storesWords = false;
    std::for_each(rows_.begin(), rows_.end(), clear);
}

void ColumnPacker::finish(std::vector<PackedColumns>& room) {
    std::vector<PackedColumns> sorted;
    for (PackedColumns& packed : rows_) {
        if (options_.descending) dropUnneeded(packed.words);
        sorted.push_back(sortClasses(box_, packed));
    }
    room = std::exchange(rows_, std::move(sorted));
}

// Adds the words of a tile of joined slices, from its first slice to its last: of each row of
// columns those of a slice are in the order of v.
void ColumnPacker::addJoined(JoinedTileReader& reader, const JoinedTile& tile) {
    const glm::ivec2 columns = reader.columns();
    constexpr int kNever = std::numeric_limits<int>::min();
    // The place at which each column had a block.
    std::vector<int> last(std::size_t(columns.x) * std::size_t(columns.y), kNever);
    std::fill(before_.begin(), before_.end(), SliceClasses{});
    std::vector<std::size_t> firstWords;
    for (const PackedColumns& packed : rows_) firstWords.push_back(packed.words.size());
    const auto addTo = [&](std::size_t column, int place, int slices) {
        const std::size_t u = column / std::size_t(columns.y);
        const std::size_t v = column % std::size_t(columns.y);
        const glm::ivec2 at = tile * columns + glm::ivec2(u, v);
        add({place, at}, column, u, slices);
    };
    // What a block showed must be taken away behind it.
    const auto endBefore = [&](std::size_t column, int place) {
        if (last[column] == kNever || last[column] != place - 1 || place > range_.lastBlock) return;
        classes_.fill(kEmptySlot);
        addTo(column, place, 1);
    };
    int place = kNever;
    const auto endAll = [&] {
        for (std::size_t column = 0; column < last.size(); ++column) endBefore(column, place + 1);
    };
    // Of too many looks nothing will be used: all is joined again.
    while (!options_.joiner->hasTooManyLooks() && reader.next()) {
        if (place != kNever && place + 1 < reader.place()) endAll();
        place = reader.place();
        for (std::size_t column = 0; column < last.size(); ++column) {
            if (!reader.has(column)) {
                endBefore(column, place);
                continue;
            }
            classes_ = reader.classes(column);
            addTo(column, place, range_.layout.slicesOf(place));
            last[column] = place;
        }
    }
    if (place != kNever) endAll();
    if (!options_.descending) return;
    for (std::size_t u = 0; u < rows_.size(); ++u) groupByColumn(rows_[u].words, firstWords[u]);
}

// Puts the words of a row of a tile one column behind the other: then a word's neighbours are those
// of its block.
void ColumnPacker::groupByColumn(std::vector<PendingWord>& words, std::size_t first) {
    std::array<std::vector<PendingWord>, std::size_t(kTileColumns.y)> columns;
    for (std::size_t i = first; i < words.size(); ++i)
        columns[std::size_t(words[i].block.y & (kTileColumns.y - 1))].push_back(words[i]);
    words.resize(first);
    for (const std::vector<PendingWord>& column : columns)
        words.insert(words.end(), column.begin(), column.end());
}

// Puts words of a column's parts along v one part behind the other.
void ColumnPacker::sortParts(std::vector<PendingWord>& words, std::size_t first) {
    std::stable_partition(words.begin() + std::ptrdiff_t(first), words.end(),
                          [](const PendingWord& word) { return word.block.y % 2 == 0; });
}

// Of slabs of changes that are walked from the last slice on, a word says what a block becomes
// where the slice behind is other, or all where a slab ends.
void ColumnPacker::dropUnneeded(std::vector<PendingWord>& words) const {
    for (std::size_t i = 0; i < words.size(); ++i) {
        const int slice = words[i].slice;
        const bool isNeeded =
            mayBeWhole(slice) || range_.layout.endsSlab(slice) || changedBehind(words, i) != 0;
        if (!isNeeded) words[i].classes = kNoClasses;
    }
}

// Whether the slab of a slice is whole, or may become so.
bool ColumnPacker::mayBeWhole(int slice) const {
    if (range_.planned.empty()) return options_.encoding != Encoding::kChanges;
    return range_.planned[std::size_t(range_.layout.slabOf(slice >> 3))].whole;
}

// What is mixed is needed around any slab: it is never taken in parts.
bool ColumnPacker::isIn(const CodeBlock& block) const {
    return tools_.mixer ||
           (block.position.x >= range_.firstBlock && block.position.x <= range_.lastBlock);
}

// Makes room for the most words that there can be.
void ColumnPacker::reserve(const Columns& columns) {
    payForWords();
    if (!range_.storesWords) return;
    const auto blocks = std::size_t(
        std::count_if(columns.begin, columns.end, [&](const CodeBlock& b) { return isIn(b); }));
    const std::size_t most =
        kMostWordsOfBlock * std::size_t(parts_.slices) * std::size_t(parts_.within) * blocks;
    for (PackedColumns& packed : rows_) reserveWords(packed, most);
}

// What is not used of it takes no memory, but for the rest of a large page.
void ColumnPacker::reserveWords(PackedColumns& packed, std::size_t most) {
    packed.words.reserve(most);
    packed.storage.reserve(64 * most);
    if (options_.painter) packed.looks.reserve(64 * most);
}

// Returns the position of a block's first part.
glm::ivec3 ColumnPacker::firstPart(const CodeBlock& block) const {
    return (block.position - parts_.origin / 8) *
           glm::ivec3(parts_.slices, parts_.within, parts_.within);
}

// Returns that of another, at these slices.
glm::ivec3 ColumnPacker::partOf(const CodeBlock& block, int slices, const glm::ivec2& part) const {
    const glm::ivec3 first = firstPart(block);
    return {slices, first.y + part.x, first.z + part.y};
}

void ColumnPacker::read(const CodeBlock& block) {
    if (tools_.holder) {
        classReader_.read(block, std::span(slots_));
        hold(slots_, block.position, {0, 0}, 0);
    } else {
        classReader_.read(block, std::span(classes_));
        if (own_) own_->paint(block.position, 0, classes_);
    }
}

// @param part    of the column: what was before is kept for each
// @param number  of what the block in hand becomes
void ColumnPacker::hold(const BlockSlots& slots, const glm::ivec3& position, const glm::ivec2& part,
                        int number) {
    HeldSlots& held = held_[numberOf(part)];
    if (own_) return holdLooks(slots, position, number, held, own_->held(numberOf(part)));
    const SlotHolder& holder = *tools_.holder;
    const auto next = [&](Slot before, Slot slot) { return holder.next(before, slot); };
    holdSlots(slots, held, next,
              [&](std::size_t i, Slot slot) { classes_[i] = holder.classOf(slot); });
}

// What is held is slot and look together, each of which has to allow it.
[[gnu::noinline]] void ColumnPacker::holdLooks(const BlockSlots& slots, const glm::ivec3& position,
                                               int number, HeldSlots& before,
                                               BlockLooks::Slice& looksBefore) {
    const SlotHolder& holder = *tools_.holder;
    for (std::size_t i = 0; i < slots.size(); ++i) classes_[i] = holder.classOf(slots[i]);
    own_->paint(position, number, classes_);
    for (std::size_t i = 0; i < slots.size(); ++i) {
        Slot& held = before[i & 63];
        OwnLook& heldOwn = looksBefore[i & 63];
        const VoxelLook look{classes_[i], own_->block()[i]};
        const VoxelLook heldLook{holder.classOf(held), heldOwn};
        const bool keeps = !(heldLook == look) && holder.allows(held, slots[i]) &&
                           options_.looksHold(heldLook, look);
        if (!keeps) {
            held = slots[i];
            heldOwn = look.own;
        }
        classes_[i] = holder.classOf(held);
        own_->block()[i] = heldOwn;
    }
}

// Calls use(position, number, part of the column, slices) for the blocks that a block becomes, but
// for those outside of the box: it may begin and end within a block.
template <typename Use>
void ColumnPacker::forMixed(const CodeBlock& block, const Use& use) const {
    for (int s = 0; s < parts_.slices; ++s) {
        forParts([&](const glm::ivec2& part) {
            const glm::ivec3 position = partOf(block, firstPart(block).x + s, part);
            const int slices = range_.layout.slicesOf(position.x);
            if (position.x < range_.layout.firstBlock || slices <= 0) return;
            const int number = (part.x * parts_.slices + s) * parts_.within + part.y;
            use(position, number, part, slices);
        });
    }
}

void ColumnPacker::addMixed(const CodeBlock& block) {
    inHand_ = &block;
    window_->reader.read(block, window_->window);
    if (uncut_) uncut_->reader.read(block.position, uncut_->window);
    const bool isSeen = tools_.sight->canBeSeen(window_->window);
    const bool isPainted = choosesClasses(options_);
    if (isSeen && isPainted) paintMixed(block);
    if (isSeen && !isPainted) tools_.mixer->mix(window_->window, *tools_.mixMap, mixed_);
    forMixed(block,
             [&](const glm::ivec3& position, int number, const glm::ivec2& part, int slices) {
                 const BlockSlots& slots = mixed_[std::size_t(number)];
                 if (!isSeen) {
                     classes_.fill(kEmptySlot);
                     held_[numberOf(part)].fill(kEmptySlot);
                 } else if (isPainted) {
                     classes_ = painted_[std::size_t(number)].classes;
                     own_->block() = painted_[std::size_t(number)].looks;
                 } else if (tools_.holder) {
                     hold(slots, position, part, number);
                 } else {
                     std::copy(slots.begin(), slots.end(), classes_.begin());
                     if (own_) own_->paint(position, number, classes_);
                 }
                 add(position, numberOf(part), std::size_t(part.x), slices);
             });
}

// Paints all that a block becomes.
void ColumnPacker::paintMixed(const CodeBlock& block) {
    painted_.resize(mixed_.size());
    for (PaintedBlock& painted : painted_) painted.classes.fill(0);
    const auto& slots = window_->window.slots;
    const bool hasSurface = options_.painter->heightOfSurface() < OwnLook::kAll;
    const bool hasEnds =
        hasSurface && std::find(slots.begin(), slots.end(), kEmptySlot) != slots.end();
    forMixed(block, [&](const glm::ivec3& position, int number, const glm::ivec2&, int) {
        own_->paint(position, number, classes_);
        if (uncut_) clearCutOff(position);
        if (hasEnds) closeEnds(position);
        painted_[std::size_t(number)] = {classes_, own_->block()};
    });
    if (parts_.divides()) keepSeen();
}

// Lets voxels that are seen for themselves be what they are, if nothing that they become is inside,
// or so near to it that most of it is seen.
void ColumnPacker::keepSeen() {
    constexpr int kNearSurface = OwnLook::kAll / 16;
    const int surface = options_.painter->heightOfSurface();
    for (int n = 0; n < 512; ++n) {
        const glm::ivec3 place(n / 64, n / 8 % 8, n % 8);
        const Slot own = window_->window.at(place);
        if (own == kEmptySlot || !options_.painter->isSeenItself(Code(own - 1))) continue;
        bool isSeen = false;
        const ValueMixer& mixer = *tools_.mixer;
        mixer.forPartsOf(place, [&](std::size_t part, std::size_t voxel) {
            const PaintedBlock& painted = painted_[part];
            const int height = painted.looks[voxel].height - kNearSurface;
            isSeen = isSeen || (painted.classes[voxel] != 0 && height <= surface);
        });
        if (isSeen) continue;
        mixer.forPartsOf(place, [&](std::size_t part, std::size_t voxel) {
            painted_[part].classes[voxel] = 1;
            painted_[part].looks[voxel] = {};
        });
    }
}

// Clears what was painted by values that were cut off: voxels that are not active any more, or
// never were and have nothing left beside them.
void ColumnPacker::clearCutOff(const glm::ivec3& position) {
    const glm::ivec3 per(parts_.slices, parts_.within, parts_.within);
    const glm::ivec3 first = 8 * (position - firstPart(*inHand_));
    for (int n = 0; n < 512; ++n) {
        if (classes_[std::size_t(n)] == 0) continue;
        const glm::ivec3 place = (first + glm::ivec3(n / 64, n / 8 % 8, n % 8)) / per;
        if (window_->window.at(place) != kEmptySlot) continue;
        if (uncut_->window.at(place) != kEmptySlot || !window_->window.hasAnyAround(place))
            classes_[std::size_t(n)] = 0;
    }
}

// Whether the volume ends, or is cut, beside a voxel: where what is not active has a value, values
// go on.
bool ColumnPacker::isAtEnd(const glm::ivec3& place) const {
    const GradientScale* scale = options_.painter->gradientScale();
    const bool endsThere = !scale || !scale->background;
    for (int n = 0; n < 6; ++n) {
        glm::ivec3 beside = place;
        beside[n / 2] += n % 2 == 0 ? -1 : 1;
        if (window_->window.at(beside) != kEmptySlot) continue;
        if (endsThere || (uncut_ && uncut_->window.at(beside) != kEmptySlot)) return true;
    }
    return false;
}

// Lets all be seen of what is inside and at an end: lines of sight that come in there have not met
// its surface.
void ColumnPacker::closeEnds(const glm::ivec3& position) {
    const glm::ivec3 per(parts_.slices, parts_.within, parts_.within);
    const glm::ivec3 first = 8 * (position - firstPart(*inHand_));
    const int surface = options_.painter->heightOfSurface();
    for (int n = 0; n < 512; ++n) {
        OwnLook& look = own_->block()[std::size_t(n)];
        if (classes_[std::size_t(n)] == 0 || look.height > surface) continue;
        if (isAtEnd((first + glm::ivec3(n / 64, n / 8 % 8, n % 8)) / per)) look = {};
    }
}

// Adds the words of the first `slices` slices of classes_.
// @param number  of the column's part, or of the column in its tile: what was before is kept for
//                each
// @param row     that it is packed in
void ColumnPacker::add(const glm::ivec3& position, std::size_t number, std::size_t row,
                       int slices) {
    SliceClasses& before = before_[number];
    PackedColumns& packed = rows_[row];
    BlockChanges changes;
    compareClasses(before.data(), classes_.data(), changes.visible.data(), changes.changed.data());
    if (own_) own_->compare(number, changes);
    planner_.add(8 * position.x, std::span(changes.visible).first(std::size_t(slices)),
                 std::span(changes.changed).first(std::size_t(slices)));
    for (int s = 0; s < slices; ++s) {
        const std::uint64_t visible = changes.visible[s];
        const std::uint64_t changed = changes.changed[s];
        const int slice = 8 * position.x + s;
        if (!isNeeded(slice, visible, changed)) continue;
        packed.words.push_back(
            {visible, changed, packed.storage.size(), slice, {position.y, position.z}});
        packed.storage.insert(packed.storage.end(), &classes_[64 * s], &classes_[64 * s] + 64);
        if (!own_) continue;
        const OwnLook* looks = &own_->block()[64 * std::size_t(s)];
        packed.looks.insert(packed.looks.end(), looks, looks + 64);
    }
    std::copy_n(&classes_[7 * 64], 64, before.begin());
    if (own_) own_->endBlock(number);
}

// Whether a word is needed of what a slice shows. Of slabs that are walked from the last slice on,
// also what the slice before a change shows.
bool ColumnPacker::isNeeded(int slice, std::uint64_t visible, std::uint64_t changed) const {
    if (!range_.storesWords) return false;
    const bool isKey = range_.layout.startsLaterSlab(slice);
    if (!range_.planned.empty()) {
        const PlannedSlab& slab = range_.planned[std::size_t(range_.layout.slabOf(slice >> 3))];
        if (options_.descending && !slab.whole) return (isKey ? visible : visible | changed) != 0;
        return slab.needs(isKey, visible, changed);
    }
    if (options_.descending && options_.encoding != Encoding::kWhole)
        return (visible | changed) != 0;
    return (options_.encoding != Encoding::kWhole && changed != 0) ||
           ((options_.encoding != Encoding::kChanges || isKey) && visible != 0);
}

}  // namespace deltasplat
