// SPDX-License-Identifier: Apache-2.0
#include "delta/word_collector.h"

#include <algorithm>
#include <utility>

#include "parallel.h"

namespace deltasplat {
namespace {

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
            forWords(run, [&](std::size_t, const PendingWord& word) { ++placeOf(run, word); });
        });
        beginSlices();
        // Not cleared here: who writes words first has their memory near.
        const std::size_t words = packed_.begins.back();
        packed_.wordStorage = std::make_unique_for_overwrite<DeltaWord[]>(words);
        packed_.words = {packed_.wordStorage.get(), words};
        if (hasLooks_) packed_.looks.resize(packed_.words.size());
        packed_.storage.resize(columns_.size());
        packed_.lookStorage.resize(columns_.size());
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            packed_.storage[i] = std::move(columns_[i]->storage);
            packed_.lookStorage[i] = std::move(columns_[i]->looks);
        }
        parallelFor(places_.size(), [&](std::size_t run) {
            forWords(run, [&](std::size_t column, const PendingWord& word) {
                const std::size_t place = placeOf(run, word)++;
                packed_.words[place] = {word.visible, changed(word),
                                        &packed_.storage[column][word.classes], word.block};
                if (hasLooks_) packed_.looks[place] = &packed_.lookStorage[column][word.classes];
            });
        });
    }

  private:
    std::uint64_t changed(const PendingWord& word) const {
        return layout_.startsLaterSlab(word.slice) ? word.visible : word.changed;
    }
    bool isNeeded(const PendingWord& word) const {
        const auto slab = std::size_t(layout_.slabOf(word.slice >> 3));
        return packed_.slabs[slab].needs(layout_.startsLaterSlab(word.slice), word.visible,
                                         word.changed);
    }

    // Calls use(column, word) for the words of a run that are needed.
    template <typename Use>
    void forWords(std::size_t run, const Use& use) {
        const auto begin = [&](std::size_t i) { return i * columns_.size() / places_.size(); };
        for (std::size_t i = begin(run); i < begin(run + 1); ++i) {
            for (const PendingWord& word : columns_[i]->words)
                if (isNeeded(word)) use(i, word);
        }
    }

    // Of a run, how many words of a slice there are; then where the next one goes.
    std::size_t& placeOf(std::size_t run, const PendingWord& word) {
        return places_[run][std::size_t(word.slice - packed_.box.min.x)];
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

}  // namespace

void collectWords(std::vector<PackedColumns*> columns, const SlabLayout& layout, bool hasLooks,
                  PackedDeltas& packed) {
    WordCollector(std::move(columns), layout, hasLooks, packed).run();
}

}  // namespace deltasplat
