// SPDX-License-Identifier: Apache-2.0
// The inner loops of packing deltas, compiled once for each SIMD level.
#include "volume/block_kernels.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/block_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "base/transpose-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <typename T>
HWY_INLINE std::uint64_t differing(const T* HWY_RESTRICT a, const T* HWY_RESTRICT b) {
    const hn::CappedTag<T, 64 / sizeof(T)> tag;
    const std::size_t lanes = hn::Lanes(tag);
    std::uint64_t word = 0;
    for (std::size_t n = 0; n < 64; n += lanes) {
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(tag, hn::Ne(hn::LoadU(tag, a + n), hn::LoadU(tag, b + n)), bits);
        std::uint64_t part;
        std::memcpy(&part, bits, sizeof part);
        word |= part << n;
    }
    return word;
}

std::uint64_t differingSlotsKernel(const Slot* a, const Slot* b) {
    return differing(a, b);
}

void compareClassesKernel(const std::uint16_t* before, const std::uint16_t* classes,
                          std::uint64_t* HWY_RESTRICT visible,
                          std::uint64_t* HWY_RESTRICT changed) {
    alignas(64) static constexpr std::uint16_t kEmpty[64] = {};
    for (int s = 0; s < 8; ++s, before = classes, classes += 64) {
        visible[s] = differing(classes, kEmpty);
        changed[s] = differing(classes, before);
    }
}

std::uint64_t countBitsKernel(std::span<const std::uint64_t> masks) {
    std::uint64_t count = 0;
    for (const std::uint64_t mask : masks) count += std::uint64_t(std::popcount(mask));
    return count;
}

MaskCounts countMasksKernel(std::span<const std::uint64_t> masks) {
    MaskCounts counts;
    for (const std::uint64_t mask : masks) {
        // Sets a row's lowest bit if any bit of the row is set.
        std::uint64_t rows = mask | mask >> 4;
        rows |= rows >> 2;
        rows |= rows >> 1;
        rows &= 0x0101010101010101;
        const auto voxels = std::uint64_t(std::popcount(mask));
        counts.voxels += voxels;
        counts.words += mask != 0;
        counts.writes += std::min(voxels, std::uint64_t(kVoxelsOfRow * std::popcount(rows)));
    }
    return counts;
}

// Writes the classes of 512 codes in order. `numbers` are codes plus kMore.
template <Code kMore>
HWY_INLINE void writeClasses(const ClassRamp& ramp, const std::uint16_t* HWY_RESTRICT numbers,
                             ClassIndex* HWY_RESTRICT classes) {
    const hn::CappedTag<std::uint16_t, 64> tag;
    const auto numberOf = [&](Code code) { return hn::Set(tag, Code(code + kMore)); };
    const auto isFrom = [&](auto number, Code least) {
        return hn::Eq(hn::Max(number, numberOf(least)), number);
    };
    for (std::size_t i = 0; i < 512; i += hn::Lanes(tag)) {
        const auto number = hn::LoadU(tag, numbers + i);
        auto shift = hn::Set(tag, ramp.pieces[0].shift);
        for (std::size_t n = 1; n < ramp.pieces.size(); ++n) {
            const RampPiece& piece = ramp.pieces[n];
            shift = hn::IfThenElse(isFrom(number, piece.begin), hn::Set(tag, piece.shift), shift);
        }
        const auto code = hn::Sub(hn::Min(number, numberOf(ramp.last)), hn::Set(tag, kMore));
        hn::StoreU(hn::IfThenElseZero(isFrom(number, ramp.first), hn::Add(code, shift)), tag,
                   classes + i);
    }
}

// Reads 8x8 values, rows `kRow` apart, and writes their columns, `kColumn` apart.
template <std::size_t kRow, std::size_t kColumn>
HWY_INLINE void transpose(const ClassIndex* HWY_RESTRICT from, ClassIndex* HWY_RESTRICT to) {
    const EightShorts tag;
    transposeEight([&](std::size_t row) { return hn::LoadU(tag, from + kRow * row); },
                   [&](std::size_t column, hn::Vec<EightShorts> values) {
                       hn::StoreU(values, tag, to + kColumn * column);
                   });
}

void classesOfLeafKernel(const ClassRamp& ramp, const Code* codes, int sliceAxis,
                         ClassIndex* classes) {
    if (sliceAxis == 0) return writeClasses<0>(ramp, codes, classes);
    HWY_ALIGN ClassIndex asStored[512];
    writeClasses<0>(ramp, codes, asStored);
    for (std::size_t i = 0; i < 8; ++i) {
        if (sliceAxis == 1) {
            transpose<64, 8>(asStored + 8 * i, classes + 64 * i);
        } else {
            transpose<8, 64>(asStored + 64 * i, classes + 8 * i);
        }
    }
}

void classesOfSlotsKernel(const ClassRamp& ramp, const ShortSlot* slots, ClassIndex* classes) {
    writeClasses<1>(ramp, slots, classes);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(differingSlotsKernel);
HWY_EXPORT(compareClassesKernel);
HWY_EXPORT(countBitsKernel);
HWY_EXPORT(countMasksKernel);
HWY_EXPORT(classesOfLeafKernel);
HWY_EXPORT(classesOfSlotsKernel);

std::uint64_t differingSlots(const Slot* a, const Slot* b) {
    return HWY_DYNAMIC_DISPATCH(differingSlotsKernel)(a, b);
}

void compareClasses(const std::uint16_t* before, const std::uint16_t* classes,
                    std::uint64_t* visible, std::uint64_t* changed) {
    HWY_DYNAMIC_DISPATCH(compareClassesKernel)(before, classes, visible, changed);
}

std::uint64_t countBits(std::span<const std::uint64_t> masks) {
    return HWY_DYNAMIC_DISPATCH(countBitsKernel)(masks);
}

MaskCounts countMasks(std::span<const std::uint64_t> masks) {
    return HWY_DYNAMIC_DISPATCH(countMasksKernel)(masks);
}

void classesOfLeaf(const ClassRamp& ramp, const Code* codes, int sliceAxis, ClassIndex* classes) {
    HWY_DYNAMIC_DISPATCH(classesOfLeafKernel)(ramp, codes, sliceAxis, classes);
}

void classesOfSlots(const ClassRamp& ramp, const ShortSlot* slots, ClassIndex* classes) {
    HWY_DYNAMIC_DISPATCH(classesOfSlotsKernel)(ramp, slots, classes);
}

}  // namespace deltasplat
#endif
