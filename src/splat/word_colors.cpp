// SPDX-License-Identifier: Apache-2.0
#include "splat/word_colors.h"

#include <atomic>
#include <bit>

#include "memory.h"
#include "optics/voxel_rounder.h"
#include "parallel.h"

namespace deltasplat {
namespace {

constexpr std::size_t kDigits = 2 * ClassTable::kMaxPlanes;

// Calls use(voxel, digits) for all that is visible of a word.
template <typename Use>
void forVisible(const PackedDeltas& deltas, std::size_t word, const VoxelRounder& rounded,
                const Use& use) {
    const DeltaWord& one = deltas.words[word];
    const VoxelColor* colors = deltas.colors[word];
    for (std::uint64_t rest = one.visible; rest != 0; rest &= rest - 1) {
        const auto n = std::size_t(std::countr_zero(rest));
        use(n, rounded({one.classes[n], colors[n]}));
    }
}

// Returns which digits any voxel has.
unsigned digitsInUse(const PackedDeltas& deltas, const VoxelRounder& rounded) {
    std::atomic<unsigned> used = 0;
    parallelForChunks(deltas.words.size(), [&](std::size_t begin, std::size_t end) {
        unsigned found = 0;
        for (std::size_t word = begin; word < end; ++word) {
            forVisible(deltas, word, rounded, [&](std::size_t, const ColorDigits& digits) {
                found |= usedDigits(digits);
            });
        }
        used |= found;
    });
    return used;
}

}  // namespace

WordColors::WordColors(const PackedDeltas& deltas, const ClassTable& classes,
                       const glm::dvec3& brightest) {
    const VoxelRounder rounded(classes, brightest);
    const std::size_t words = deltas.words.size();
    // The first digit is always there.
    const unsigned used = digitsInUse(deltas, rounded) | 1;
    table_.scale = rounded.scale();
    table_.planes.resize(used < 4 ? 1 : 2);
    table_.looks.resize(1);
    table_.classOfSlot.assign(kSlotCount, kEmptySlot);
    for (std::size_t p = 0; p < table_.planes.size(); ++p)
        if (used >> (2 * p + 1) & 1) table_.planes[p].low.colors.resize(1);

    const double digits = std::popcount(used) + (table_.planes.size() == 2 ? 1 : 0);
    requireMemory("colours of voxels", digits * double(sizeof(Colors)) * double(words));
    for (std::size_t d = 0; d < kDigits; ++d)
        if (used >> d & 1 || (d == 2 && used > 3)) digits_[d].resize(words);
    parallelForChunks(words, [&](std::size_t begin, std::size_t end) {
        for (std::size_t word = begin; word < end; ++word) {
            forVisible(deltas, word, rounded, [&](std::size_t n, const ColorDigits& color) {
                for (std::size_t d = 0; d < kDigits; ++d)
                    if (!digits_[d].empty()) digits_[d][word][n] = color[d];
            });
        }
    });
    if (!table_.oneDigit())
        digitVoxels_ = DigitVoxels(words, table_, [&](DigitPlace digit, std::size_t word) {
            return voxelsOf(digit, word);
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
