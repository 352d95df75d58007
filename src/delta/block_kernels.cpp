// SPDX-License-Identifier: Apache-2.0
// The differencing's inner loop, compiled once for each SIMD level.
#include "delta/block_kernels.h"

#include <cstring>

#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "delta/block_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
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

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(differingSlotsKernel);
HWY_EXPORT(compareClassesKernel);

std::uint64_t differingSlots(const Slot* a, const Slot* b) {
    return HWY_DYNAMIC_DISPATCH(differingSlotsKernel)(a, b);
}

void compareClasses(const std::uint16_t* before, const std::uint16_t* classes,
                    std::uint64_t* visible, std::uint64_t* changed) {
    HWY_DYNAMIC_DISPATCH(compareClassesKernel)(before, classes, visible, changed);
}

}  // namespace deltasplat
#endif
