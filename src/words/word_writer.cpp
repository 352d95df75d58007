// SPDX-License-Identifier: Apache-2.0
#include "words/word_writer.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "volume/block_kernels.h"

namespace deltasplat {

namespace {

// Removes all words but keeps their memory.
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

// Unused reserved memory costs nothing, except within a large page.
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

// Whether a slice's word is made. Walking backwards also needs the slice before a change.
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

bool WordWriter::mayBeWhole(int slice) const {
    if (range_.planned.empty()) return encoding_ != Encoding::kChanges;
    return range_.planned[std::size_t(range_.layout.slabOf(slice >> 3))].whole;
}

// Walking backwards, words of deltas need classes only before a change or at the slab's end.
void WordWriter::dropUnneeded(std::vector<PendingWord>& words) const {
    for (std::size_t i = 0; i < words.size(); ++i) {
        const int slice = words[i].slice;
        const bool isNeeded =
            mayBeWhole(slice) || range_.layout.endsSlab(slice) || changedBehind(words, i) != 0;
        if (!isNeeded) words[i].classes = kNoClasses;
    }
}

namespace {

constexpr std::array<OwnLook, 64> kNoLooks{};

bool follows(const PendingWord& before, const PendingWord& word) {
    return before.block == word.block && before.slice + 1 == word.slice;
}

// Moves words into slice order. Parallel runs have places of their own, one run after the other.
class WordCollector {
  public:
    WordCollector(std::vector<PackedColumns*> columns, const SlabLayout& layout, bool hasLooks,
                  PackedDeltas& packed)
        : columns_(std::move(columns)), layout_(layout), hasLooks_(hasLooks), packed_(packed) {
        // Tables of places must stay small compared to the words.
        constexpr std::size_t kWordsForPlace = 16;
        std::size_t words = 0;
        for (const PackedColumns* column : columns_) words += column->words.size();
        const auto slices = std::size_t(packed.box.dims().x);
        const std::size_t runs = std::min(words / (kWordsForPlace * slices), columns_.size());
        places_.assign(std::max<std::size_t>(runs, 1), std::vector<std::size_t>(slices));
    }

    void run() {
        parallelFor(places_.size(), [&](std::size_t run) {
            forWords(run, [&](std::size_t, const NeededWord& word) { ++placeOf(run, word.slice); });
        });
        beginSlices();
        // Not cleared, because the thread that first writes words should own their memory.
        packed_.words.resize(packed_.begins.back());
        if (hasLooks_) packed_.looks.resize(packed_.words.size());
        packed_.storage.resize(columns_.size());
        packed_.lookStorage.resize(columns_.size());
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            packed_.storage[i] = std::move(columns_[i]->storage);
            packed_.lookStorage[i] = std::move(columns_[i]->looks);
        }
        parallelFor(places_.size(), [&](std::size_t run) {
            forWords(run, [&](std::size_t column, const NeededWord& word) {
                add(placeOf(run, word.slice)++, column, word);
            });
        });
    }

  private:
    // A final word, with changes relative to the previously walked slice.
    using NeededWord = PendingWord;
    template <typename Use>
    void forWords(std::size_t run, const Use& use) {
        const auto begin = [&](std::size_t i) { return i * columns_.size() / places_.size(); };
        for (std::size_t i = begin(run); i < begin(run + 1); ++i) {
            const auto useNeeded = [&](NeededWord word, bool isKey) {
                const auto slab = std::size_t(layout_.slabOf(word.slice >> 3));
                const PlannedSlab& planned = packed_.slabs[slab];
                if (!planned.needs(isKey, word.visible, word.changed)) return;
                if (isKey || planned.whole) word.changed = word.visible;
                use(i, word);
            };
            const std::vector<PendingWord>& words = columns_[i]->words;
            for (std::size_t word = 0; word < words.size(); ++word) {
                if (packed_.descending) {
                    addDescending(words, word, useNeeded);
                } else {
                    useNeeded(words[word], layout_.startsLaterSlab(words[word].slice));
                }
            }
        }
    }

    // Walked backwards, a change happens in the slice before.
    template <typename Use>
    void addDescending(const std::vector<PendingWord>& words, std::size_t number,
                       const Use& use) const {
        const PendingWord& word = words[number];
        const bool hasBefore = number > 0 && follows(words[number - 1], word);
        if (!hasBefore && word.slice > packed_.box.min.x && !layout_.startsLaterSlab(word.slice))
            use({0, word.changed, kNoClasses, word.slice - 1, word.block}, false);
        NeededWord turned = word;
        turned.changed = changedBehind(words, number);
        use(turned, layout_.endsSlab(word.slice));
    }

    // Number of a run's words in a slice; later the place of the next one.
    std::size_t& placeOf(std::size_t run, int slice) {
        return places_[run][std::size_t(slice - packed_.box.min.x)];
    }

    void add(std::size_t place, std::size_t column, const NeededWord& word) {
        const bool isEmpty = word.classes == kNoClasses;
        packed_.words[place] = {
            word.visible, word.changed,
            isEmpty ? kEmptyClasses.data() : &packed_.storage[column][word.classes], word.block};
        if (!hasLooks_) return;
        packed_.looks[place] =
            isEmpty ? kNoLooks.data() : &packed_.lookStorage[column][word.classes];
    }

    void beginSlices() {
        std::size_t place = 0;
        for (std::size_t slice = 0; slice < places_.front().size(); ++slice) {
            packed_.begins.push_back(place);
            for (std::vector<std::size_t>& ofRun : places_)
                place += std::exchange(ofRun[slice], place);
        }
        packed_.begins.push_back(place);
    }

    std::vector<PackedColumns*> columns_;  // ordered by u, then v
    const SlabLayout& layout_;
    bool hasLooks_;
    PackedDeltas& packed_;
    std::vector<std::vector<std::size_t>> places_;  // [run][slice]
};

// Returns the pieces of 64 that words point to.
// @param places  [word]: start of its piece in the result
template <typename Pieces>
Pieces sorted(const Pieces& pieces, const std::vector<PendingWord>& words,
              const std::vector<std::size_t>& places, std::size_t count) {
    Pieces result(64 * count);
    for (std::size_t i = 0; i < words.size(); ++i)
        if (words[i].classes != kNoClasses)
            std::copy_n(&pieces[words[i].classes], 64, &result[places[i]]);
    return result;
}

}  // namespace

std::uint64_t changedBehind(const std::vector<PendingWord>& words, std::size_t word) {
    const bool isLast = word + 1 == words.size() || !follows(words[word], words[word + 1]);
    return isLast ? 0 : words[word + 1].changed;
}

PackedColumns sortClasses(const IndexBox& box, const PackedColumns& columns) {
    // [slice]: number of words; later the place of the next one.
    std::vector<std::size_t> next(std::size_t(box.dims().x));
    const auto ofSlice = [&](const PendingWord& word) -> std::size_t& {
        return next[std::size_t(word.slice - box.min.x)];
    };
    std::size_t count = 0;
    for (const PendingWord& word : columns.words) {
        if (word.classes == kNoClasses) continue;
        ++ofSlice(word);
        ++count;
    }
    std::exclusive_scan(next.begin(), next.end(), next.begin(), std::size_t{0});
    std::vector<std::size_t> places;
    places.reserve(columns.words.size());
    for (const PendingWord& word : columns.words)
        places.push_back(word.classes == kNoClasses ? kNoClasses : 64 * ofSlice(word)++);
    PackedColumns result{columns.words, sorted(columns.storage, columns.words, places, count), {}};
    if (!columns.looks.empty()) result.looks = sorted(columns.looks, columns.words, places, count);
    for (std::size_t i = 0; i < places.size(); ++i) result.words[i].classes = places[i];
    return result;
}

void collectWords(std::vector<PackedColumns*> columns, const SlabLayout& layout, bool hasLooks,
                  PackedDeltas& packed) {
    WordCollector(std::move(columns), layout, hasLooks, packed).run();
}

}  // namespace deltasplat
