// SPDX-License-Identifier: Apache-2.0
// The inner loops of packing deltas, compiled once for each SIMD level.
#include "delta/block_kernels.h"

#include <bit>
#include <cstring>

#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "delta/block_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "transpose-inl.h"

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

// Writes the classes of 512 codes in their order.
HWY_INLINE void writeClasses(const ClassRamp& ramp, const Code* HWY_RESTRICT codes,
                             ClassIndex* HWY_RESTRICT classes) {
    const hn::CappedTag<std::uint16_t, 64> tag;
    const auto isFrom = [&](auto code, Code least) {
        return hn::Eq(hn::Max(code, hn::Set(tag, least)), code);
    };
    for (std::size_t i = 0; i < 512; i += hn::Lanes(tag)) {
        const auto code = hn::LoadU(tag, codes + i);
        auto shift = hn::Set(tag, ramp.pieces[0].shift);
        for (std::size_t n = 1; n < ramp.pieces.size(); ++n) {
            const RampPiece& piece = ramp.pieces[n];
            shift = hn::IfThenElse(isFrom(code, piece.begin), hn::Set(tag, piece.shift), shift);
        }
        const auto sum = hn::Add(hn::Min(code, hn::Set(tag, ramp.last)), shift);
        hn::StoreU(hn::IfThenElseZero(isFrom(code, ramp.first), sum), tag, classes + i);
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
    if (sliceAxis == 0) return writeClasses(ramp, codes, classes);
    HWY_ALIGN ClassIndex asStored[512];
    writeClasses(ramp, codes, asStored);
    for (std::size_t i = 0; i < 8; ++i) {
        if (sliceAxis == 1) {
            transpose<64, 8>(asStored + 8 * i, classes + 64 * i);
        } else {
            transpose<8, 64>(asStored + 64 * i, classes + 8 * i);
        }
    }
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(differingSlotsKernel);
HWY_EXPORT(compareClassesKernel);
HWY_EXPORT(countBitsKernel);
HWY_EXPORT(classesOfLeafKernel);

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

void classesOfLeaf(const ClassRamp& ramp, const Code* codes, int sliceAxis, ClassIndex* classes) {
    HWY_DYNAMIC_DISPATCH(classesOfLeafKernel)(ramp, codes, sliceAxis, classes);
}

}  // namespace deltasplat
#endif
