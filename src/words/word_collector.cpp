// SPDX-License-Identifier: Apache-2.0
#include "words/word_collector.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "base/parallel.h"

namespace deltasplat {

namespace {

// Of 64 voxels.
constexpr std::array<OwnLook, 64> kNoLooks{};

// Whether a word is of the next slice of the same block.
bool follows(const PendingWord& before, const PendingWord& word) {
    return before.block == word.block && before.slice + 1 == word.slice;
}

// Puts the packers' words in the order of slices. Runs of columns do so at once: each knows where
// its words of a slice begin, behind those of the runs before.
class WordCollector {
  public:
    WordCollector(std::vector<PackedColumns*> columns, const SlabLayout& layout, bool hasLooks,
                  PackedDeltas& packed)
        : columns_(std::move(columns)), layout_(layout), hasLooks_(hasLooks), packed_(packed) {
        // Places of words take no more than a small share of what words do.
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
        // Not cleared here: who writes words first has their memory near.
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
    // A word as it will be: what has changed is told from the slice that is walked before.
    using NeededWord = PendingWord;
    // Calls use(column, word) for the words of a run that are needed.
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

    // What changes from a slice to the one behind it changes back on the way from that one.
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

    // Of a run, how many words of a slice there are; then where the next one goes.
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

// Returns pieces of 64, of words that point to any, as many as there are.
// @param places  [word]: where its piece begins in the result
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
    // [slice]: how many words it has; then where its next one goes.
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
