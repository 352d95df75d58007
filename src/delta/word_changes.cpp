// SPDX-License-Identifier: Apache-2.0
#include "delta/word_changes.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "parallel.h"

namespace deltasplat {
namespace {

using Words = std::span<const DeltaWord>;

enum class RowState : std::uint8_t { kEmpty, kSame, kDiffers };

// Compares the words of one slab.
class SlabComparison {
  public:
    SlabComparison(const PackedDeltas& before, const PackedDeltas& now,
                   std::span<const ClassIndex> nowOfBefore, bool isSameNumber)
        : before_(before),
          now_(now),
          nowOfBefore_(nowOfBefore),
          isSameNumber_(isSameNumber),
          firstRow_(before.box.min.y >> 3),
          states_(std::size_t((before.box.max.y >> 3) - firstRow_ + 1)) {}

    void compare(std::size_t slab) {
        const PlannedSlab& one = now_.slabs[slab];
        const bool areAlike = before_.slabs[slab].whole == one.whole;
        for (int slice = one.firstSlice; slice < one.firstSlice + one.sliceCount; ++slice)
            compareSlice(before_.slice(slice), now_.slice(slice), areAlike);
    }

    SlabChanges found() const {
        SlabChanges found;
        for (std::size_t i = 0; i < states_.size(); ++i) {
            if (states_[i] == RowState::kEmpty) continue;
            const int row = firstRow_ + int(i);
            if (found.shown++ == 0) found.shownRows.x = row;
            found.shownRows.y = row + 1;
            if (states_[i] == RowState::kSame) continue;
            if (found.differing++ == 0) found.differingRows.x = row;
            found.differingRows.y = row + 1;
        }
        return found;
    }

  private:
    static Words takeRow(Words& words, int row) {
        const auto end = std::partition_point(
            words.begin(), words.end(), [&](const DeltaWord& word) { return word.block.x <= row; });
        const auto count = std::size_t(end - words.begin());
        const Words taken = words.first(count);
        words = words.subspan(count);
        return taken;
    }

    void compareSlice(Words before, Words now, bool areAlike) {
        constexpr int kNone = std::numeric_limits<int>::max();
        while (!before.empty() || !now.empty()) {
            const int row = std::min(before.empty() ? kNone : before.front().block.x,
                                     now.empty() ? kNone : now.front().block.x);
            const Words rowBefore = takeRow(before, row);
            const Words rowNow = takeRow(now, row);
            RowState& state = states_[std::size_t(row - firstRow_)];
            if (state == RowState::kDiffers) continue;
            const bool isSame =
                areAlike && std::equal(rowBefore.begin(), rowBefore.end(), rowNow.begin(),
                                       rowNow.end(), [&](const DeltaWord& a, const DeltaWord& b) {
                                           return isSameWord(a, b);
                                       });
            state = isSame ? RowState::kSame : RowState::kDiffers;
        }
    }

    bool isSameWord(const DeltaWord& before, const DeltaWord& now) const {
        if (before.visible != now.visible || before.changed != now.changed ||
            before.block != now.block) {
            return false;
        }
        const OwnLook* looksBefore = looksOf(before_, before);
        const OwnLook* looksNow = looksOf(now_, now);
        if ((looksBefore == nullptr) != (looksNow == nullptr)) return false;
        if (isSameNumber_ && std::equal(now.classes, now.classes + 64, before.classes) &&
            (!looksNow || std::equal(looksNow, looksNow + 64, looksBefore))) {
            return true;
        }
        // Voxels that cannot be seen may be anything.
        for (std::uint64_t left = now.visible; left != 0; left &= left - 1) {
            const auto n = std::size_t(std::countr_zero(left));
            if (nowOfBefore_[before.classes[n]] != now.classes[n]) return false;
            if (looksNow && !(looksBefore[n] == looksNow[n])) return false;
        }
        return true;
    }

    static const OwnLook* looksOf(const PackedDeltas& deltas, const DeltaWord& word) {
        return deltas.looks.empty() ? nullptr
                                    : deltas.looks[std::size_t(&word - deltas.words.data())];
    }

    const PackedDeltas& before_;
    const PackedDeltas& now_;
    std::span<const ClassIndex> nowOfBefore_;
    bool isSameNumber_;  // of every class
    int firstRow_;
    std::vector<RowState> states_;  // [rows of blocks]
};

}  // namespace

bool haveSameSlabs(const PackedDeltas& before, const PackedDeltas& now) {
    const bool areToldAlike =
        before.descending == now.descending || (before.areWhole() && now.areWhole());
    return areToldAlike && before.sliceAxis == now.sliceAxis && before.box == now.box &&
           std::equal(before.slabs.begin(), before.slabs.end(), now.slabs.begin(), now.slabs.end(),
                      [](const PlannedSlab& a, const PlannedSlab& b) {
                          return a.firstSlice == b.firstSlice && a.sliceCount == b.sliceCount;
                      });
}

std::vector<SlabChanges> compareWords(const PackedDeltas& before, const PackedDeltas& now,
                                      std::span<const ClassIndex> nowOfBefore) {
    bool isSameNumber = true;
    for (std::size_t number = 1; number < nowOfBefore.size(); ++number)
        isSameNumber = isSameNumber && nowOfBefore[number] == number;
    std::vector<SlabChanges> changes(now.slabs.size());
    parallelFor(changes.size(), [&](std::size_t slab) {
        SlabComparison comparison(before, now, nowOfBefore, isSameNumber);
        comparison.compare(slab);
        changes[slab] = comparison.found();
    });
    return changes;
}

}  // namespace deltasplat
