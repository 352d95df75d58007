// SPDX-License-Identifier: Apache-2.0
#include "words/word_writer.h"

#include <algorithm>
#include <utility>

#include "volume/block_kernels.h"

namespace deltasplat {
namespace {

// Takes all words out, and keeps their memory.
void clear(PackedColumns& packed) {
    packed.words.clear();
    packed.storage.clear();
    packed.looks.clear();
}

}  // namespace

WordWriter::WordWriter(const IndexBox& box, const PackOptions& options, const PackRange& range,
                       std::size_t columns)
    : box_(box),
      encoding_(options.encoding),
      descending_(options.descending),
      hasLooks_(options.painter != nullptr),
      range_(range),
      planner_(box),
      before_(columns) {}

void WordWriter::begin(std::size_t rows, std::vector<PackedColumns>& room) {
    rows_ = std::move(room);
    rows_.resize(rows);
    std::for_each(rows_.begin(), rows_.end(), clear);
    payForWords();
}

// What is not used of it takes no memory, but for the rest of a large page.
void WordWriter::reserve(std::size_t row, std::size_t most) {
    if (!range_.storesWords) return;
    PackedColumns& packed = rows_[row];
    packed.words.reserve(most);
    packed.storage.reserve(64 * most);
    if (hasLooks_) packed.looks.reserve(64 * most);
}

void WordWriter::beginColumns() {
    std::fill(before_.begin(), before_.end(), std::array<ClassIndex, 64>{});
}

void WordWriter::add(const BlockClasses& classes, BlockLooks* looks, const glm::ivec3& position,
                     std::size_t column, std::size_t row, int slices) {
    std::array<ClassIndex, 64>& before = before_[column];
    PackedColumns& packed = rows_[row];
    BlockChanges changes;
    compareClasses(before.data(), classes.data(), changes.visible.data(), changes.changed.data());
    if (looks) looks->compare(column, changes);
    planner_.add(8 * position.x, std::span(changes.visible).first(std::size_t(slices)),
                 std::span(changes.changed).first(std::size_t(slices)));
    for (int s = 0; s < slices; ++s) {
        const std::uint64_t visible = changes.visible[s];
        const std::uint64_t changed = changes.changed[s];
        const int slice = 8 * position.x + s;
        if (!isNeeded(slice, visible, changed)) continue;
        packed.words.push_back(
            {visible, changed, packed.storage.size(), slice, {position.y, position.z}});
        packed.storage.insert(packed.storage.end(), &classes[64 * s], &classes[64 * s] + 64);
        if (!looks) continue;
        const OwnLook* ofSlice = &looks->block()[64 * std::size_t(s)];
        packed.looks.insert(packed.looks.end(), ofSlice, ofSlice + 64);
    }
    std::copy_n(&classes[7 * 64], 64, before.begin());
    if (looks) looks->endBlock(column);
}

void WordWriter::payForWords() {
    if (!range_.budget || !range_.storesWords) return;
    std::size_t words = 0;
    for (const PackedColumns& packed : rows_) words += packed.words.size();
    if (range_.budget->take(words - std::exchange(paidWords_, words))) return;
    range_.storesWords = false;
    std::for_each(rows_.begin(), rows_.end(), clear);
}

void WordWriter::finish(std::vector<PackedColumns>& room) {
    std::vector<PackedColumns> sorted;
    for (PackedColumns& packed : rows_) {
        if (descending_) dropUnneeded(packed.words);
        sorted.push_back(sortClasses(box_, packed));
    }
    room = std::exchange(rows_, std::move(sorted));
}

// Whether a word is needed of what a slice shows. Of slabs that are walked from the last slice on,
// also what the slice before a change shows.
bool WordWriter::isNeeded(int slice, std::uint64_t visible, std::uint64_t changed) const {
    if (!range_.storesWords) return false;
    const bool isKey = range_.layout.startsLaterSlab(slice);
    if (!range_.planned.empty()) {
        const PlannedSlab& slab = range_.planned[std::size_t(range_.layout.slabOf(slice >> 3))];
        if (descending_ && !slab.whole) return (isKey ? visible : visible | changed) != 0;
        return slab.needs(isKey, visible, changed);
    }
    if (descending_ && encoding_ != Encoding::kWhole) return (visible | changed) != 0;
    return (encoding_ != Encoding::kWhole && changed != 0) ||
           ((encoding_ != Encoding::kChanges || isKey) && visible != 0);
}

// Whether the slab of a slice is whole, or may become so.
bool WordWriter::mayBeWhole(int slice) const {
    if (range_.planned.empty()) return encoding_ != Encoding::kChanges;
    return range_.planned[std::size_t(range_.layout.slabOf(slice >> 3))].whole;
}

// Of slabs of changes that are walked from the last slice on, a word says what a block becomes
// where the slice behind is other, or all where a slab ends.
void WordWriter::dropUnneeded(std::vector<PendingWord>& words) const {
    for (std::size_t i = 0; i < words.size(); ++i) {
        const int slice = words[i].slice;
        const bool isNeeded =
            mayBeWhole(slice) || range_.layout.endsSlab(slice) || changedBehind(words, i) != 0;
        if (!isNeeded) words[i].classes = kNoClasses;
    }
}

}  // namespace deltasplat
