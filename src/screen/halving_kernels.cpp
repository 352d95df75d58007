// SPDX-License-Identifier: Apache-2.0
// Sums run in a fixed order whatever a vector's width, so all SIMD levels give the same bits.
#include "screen/halving_kernels.h"

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "screen/halving_kernels.cpp"
#include "hwy/foreach_target.h"
// Highway requires this after foreach_target.h.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Tag, class Vector = hn::Vec<Tag>>
HWY_INLINE Vector sumOfFour(Tag tag, Vector first, Vector second, Vector third, Vector fourth) {
    const auto outer = hn::Mul(hn::Add(first, fourth), hn::Set(tag, 0.125f));
    const auto inner = hn::Mul(hn::Add(second, third), hn::Set(tag, 0.375f));
    return hn::Add(outer, inner);
}

template <class Tag>
HWY_INLINE std::size_t addRowsFrom(Tag tag, std::size_t i, const float* const rows[4],
                                   std::size_t count, float* HWY_RESTRICT out) {
    for (; i + hn::Lanes(tag) <= count; i += hn::Lanes(tag)) {
        hn::StoreU(sumOfFour(tag, hn::LoadU(tag, rows[0] + i), hn::LoadU(tag, rows[1] + i),
                             hn::LoadU(tag, rows[2] + i), hn::LoadU(tag, rows[3] + i)),
                   tag, out + i);
    }
    return i;
}

void addFourRowsKernel(const float* const rows[4], std::size_t count, float* HWY_RESTRICT out) {
    const std::size_t done = addRowsFrom(hn::ScalableTag<float>(), 0, rows, count, out);
    addRowsFrom(hn::CappedTag<float, 1>(), done, rows, count, out);
}

template <int kChannels>
HWY_INLINE void addColumns(const float* row, int pixels, float* HWY_RESTRICT out) {
    const hn::CappedTag<float, kChannels> tag;
    const auto pixel = [&](std::ptrdiff_t i) { return hn::LoadU(tag, row + kChannels * i); };
    for (std::ptrdiff_t i = 0; i < pixels; ++i) {
        hn::StoreU(
            sumOfFour(tag, pixel(2 * i), pixel(2 * i + 1), pixel(2 * i + 2), pixel(2 * i + 3)), tag,
            out + kChannels * i);
    }
}

void addFourColumnsKernel(const float* row, int channels, int pixels, float* HWY_RESTRICT out) {
    channels == 4 ? addColumns<4>(row, pixels, out) : addColumns<1>(row, pixels, out);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(addFourRowsKernel);
HWY_EXPORT(addFourColumnsKernel);

void addFourRows(const float* const rows[4], std::size_t count, float* out) {
    HWY_DYNAMIC_DISPATCH(addFourRowsKernel)(rows, count, out);
}

void addFourColumns(const float* row, int channels, int pixels, float* out) {
    HWY_DYNAMIC_DISPATCH(addFourColumnsKernel)(row, channels, pixels, out);
}

}  // namespace deltasplat
#endif
