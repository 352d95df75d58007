// SPDX-License-Identifier: Apache-2.0
#include "splat/word_colors.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "memory.h"
#include "optics/color_digits.h"
#include "optics/digit_kernels.h"
#include "parallel.h"

namespace deltasplat {
namespace {

constexpr std::size_t kDigits = 2 * ClassTable::kMaxPlanes;

// Lights the words of a piece, one after the other.
class WordLighter {
  public:
    WordLighter(const PackedDeltas& deltas, const LookLight& light)
        : deltas_(deltas), light_(light) {}

    // Returns the premultiplied colours of a word's voxels.
    const WordUnits& unitsOf(std::size_t word) {
        const auto& begins = deltas_.begins;
        if (word < begins[slice_] || word >= begins[slice_ + 1]) {
            const auto behind = std::upper_bound(begins.begin(), begins.end(), word);
            slice_ = std::size_t(behind - begins.begin() - 1);
        }
        const DeltaWord& one = deltas_.words[word];
        const WordPlace place(deltas_.box.min.x + int(slice_), 8 * one.block);
        light_.light(place, one.classes, deltas_.looks[word], units_);
        return units_;
    }

  private:
    const PackedDeltas& deltas_;
    const LookLight& light_;
    std::size_t slice_ = 0;  // of the word in hand, counted from the first
    WordUnits units_;
};

// Calls use(voxel) for the voxels of a mask.
template <typename Use>
void forVoxels(std::uint64_t mask, const Use& use) {
    for (; mask != 0; mask &= mask - 1) use(std::size_t(std::countr_zero(mask)));
}

// Clears colours but for those of a mask.
void keepOnly(std::uint64_t mask, std::array<ClassTable::Color, 64>& colors) {
    if (mask == 0) {
        colors = {};
        return;
    }
    forVoxels(~mask, [&](std::size_t n) { colors[n] = {}; });
}

ColorDigits digitsOfVoxel(const WordUnits& units, std::size_t n) {
    return digitsOf({units[0][n], units[1][n], units[2][n], units[3][n]});
}

}  // namespace

WordColors::WordColors(const PackedDeltas& deltas, const LookLight& light,
                       std::pmr::memory_resource& memory) {
    const std::size_t words = deltas.words.size();
    const auto makeDigits = [&](std::size_t digit) {
        digits_[digit] = UnclearedArray<Colors>(words, memory);
    };
    const double digitBytes = double(sizeof(Colors)) * double(words);
    requireMemory("colours of voxels", 2 * digitBytes);
    makeDigits(0);
    makeDigits(1);
    // Voxels with a low digit, and those of them that may be on the second plane.
    std::vector<std::uint64_t> low(words);
    std::vector<std::uint64_t> planes(words);
    std::atomic<unsigned> used = 1;
    parallelForChunks(words, [&](std::size_t begin, std::size_t end) {
        WordLighter lit(deltas, light);
        unsigned inPiece = 0;
        for (std::size_t word = begin; word < end; ++word) {
            const std::uint64_t visible = deltas.words[word].visible;
            Colors& colors = digits_[0][word];
            if (visible == 0) {
                keepOnly(0, colors);
                continue;
            }
            const WordUnits& units = lit.unitsOf(word);
            const MoreDigits more = writeDigits(units, colors.data(), digits_[1][word].data());
            keepOnly(visible, colors);
            low[word] = more.low & visible;
            planes[word] = more.planes & visible;
            if (low[word] != 0) inPiece |= 2;
            forVoxels(planes[word],
                      [&](std::size_t n) { inPiece |= usedDigits(digitsOfVoxel(units, n)); });
        }
        used |= inPiece;
    });
    table_.scale = light.units().scale();
    table_.planes.resize(used < 4 ? 1 : 2);
    table_.looks.resize(1);
    table_.classOfSlot.assign(kSlotCount, kEmptySlot);
    for (std::size_t p = 0; p < table_.planes.size(); ++p)
        if (used >> (2 * p + 1) & 1) table_.planes[p].low.colors.resize(1);
    if (table_.oneDigit()) {
        digits_[1] = {};
        return;
    }
    const bool hasPlanes = table_.planes.size() > 1;
    if (hasPlanes) {
        requireMemory("colours of voxels", 4 * digitBytes);
        for (std::size_t d = 2; d < kDigits; ++d) makeDigits(d);
    }
    parallelForChunks(words, [&](std::size_t begin, std::size_t end) {
        WordLighter lit(deltas, light);
        for (std::size_t word = begin; word < end; ++word) {
            keepOnly(low[word], digits_[1][word]);
            if (!hasPlanes) continue;
            for (std::size_t d = 2; d < kDigits; ++d) digits_[d][word] = {};
            if (planes[word] == 0) continue;
            const WordUnits& units = lit.unitsOf(word);
            forVoxels(planes[word], [&](std::size_t n) {
                const ColorDigits digits = digitsOfVoxel(units, n);
                for (std::size_t d = 0; d < kDigits; ++d) digits_[d][word][n] = digits[d];
            });
        }
    });
    digitVoxels_ = DigitVoxels(words, table_, [&](DigitPlace digit, std::size_t word) {
        if (hasPlanes) return voxelsOf(digit, word);
        return digit.low ? low[word] : deltas.words[word].visible;
    });
}

// Of a word, the voxels that have a digit; of the high one, those with anything on the plane.
std::uint64_t WordColors::voxelsOf(DigitPlace digit, std::size_t word) const {
    constexpr ClassTable::Color kNothing{};
    const std::size_t low = numberOf({digit.plane, true});
    const std::size_t high = numberOf({digit.plane, false});
    std::uint64_t voxels = 0;
    for (std::size_t n = 0; n < 64; ++n) {
        const bool hasLow = !digits_[low].empty() && digits_[low][word][n] != kNothing;
        const bool has = digit.low ? hasLow : hasLow || digits_[high][word][n] != kNothing;
        voxels |= std::uint64_t{has} << n;
    }
    return voxels;
}

}  // namespace deltasplat
