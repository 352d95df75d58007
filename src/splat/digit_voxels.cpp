// SPDX-License-Identifier: Apache-2.0
// Finds classes of a range among 64, compiled once per SIMD level.
#include "splat/digit_voxels.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splat/digit_voxels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Bit n of voxels[i]: whether class n of word i is one of [first, first + count).
void findInRangeKernel(const DeltaWord* words, std::size_t size, ClassIndex first, ClassIndex count,
                       std::uint64_t* HWY_RESTRICT voxels) {
    const hn::CappedTag<ClassIndex, 32> tag;
    const auto begin = hn::Set(tag, first);
    const auto length = hn::Set(tag, count);
    for (std::size_t i = 0; i < size; ++i) {
        std::uint64_t found = 0;
        for (std::size_t n = 0; n < 64; n += hn::Lanes(tag)) {
            const auto classes = hn::LoadU(tag, words[i].classes + n);
            std::uint8_t bits[8] = {};
            hn::StoreMaskBits(tag, hn::Lt(hn::Sub(classes, begin), length), bits);
            std::uint64_t part;
            std::memcpy(&part, bits, sizeof part);
            found |= part << n;
        }
        voxels[i] = found;
    }
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(findInRangeKernel);

namespace {

// The classes to find. With the high digit, also classes with a low digit only.
ClassTable::Digit rangeOf(const ClassTable::Plane& plane, bool low) {
    if (low) return {{}, plane.low.first, plane.low.last};
    if (plane.low.colors.empty()) return {{}, plane.high.first, plane.high.last};
    // An empty range begins and ends with 1.
    const bool highIsEmpty = plane.high.first == plane.high.last;
    return {{},
            highIsEmpty ? plane.low.first : std::min(plane.high.first, plane.low.first),
            std::max(plane.high.last, plane.low.last)};
}

}  // namespace

DigitVoxels::DigitVoxels(const PackedDeltas& deltas, const ClassTable& classes, bool withLow) {
    const std::span<const DeltaWord> words = deltas.words;
    for (std::size_t p = 0; p < classes.planes.size(); ++p) {
        const ClassTable::Plane& plane = classes.planes[p];
        for (const bool low : {false, true}) {
            if (low ? !withLow || plane.low.colors.empty() : classes.planes.size() == 1) continue;
            requireMemory("digits of colours",
                          double(sizeof(std::uint64_t)) * double(words.size()));
            std::vector<std::uint64_t>& voxels = voxels_[p][low];
            voxels.resize(words.size());
            const ClassTable::Digit range = rangeOf(plane, low);
            parallelForChunks(words.size(), [&](std::size_t begin, std::size_t end) {
                HWY_DYNAMIC_DISPATCH(findInRangeKernel)
                (words.data() + begin, end - begin, ClassIndex(range.first),
                 ClassIndex(range.last - range.first), voxels.data() + begin);
            });
        }
    }
}

bool DigitVoxels::fewerThan(std::uint64_t voxels, DigitPlace digit) const {
    std::uint64_t found = 0;
    std::uint64_t words = 0;
    for (const std::uint64_t word : voxels_[std::size_t(digit.plane)][digit.low ? 1 : 0]) {
        found += std::uint64_t(std::popcount(word));
        words += word != 0;
    }
    return found < voxels * words;
}

}  // namespace deltasplat
#endif
