// SPDX-License-Identifier: Apache-2.0
// Shared by the splatting kernels, compiled once per SIMD level: include it after Highway.
// No #pragma once, for each level includes it anew.
#if defined(DELTASPLAT_PAIR_PRODUCTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DELTASPLAT_PAIR_PRODUCTS_INL_H
#undef DELTASPLAT_PAIR_PRODUCTS_INL_H
#else
#define DELTASPLAT_PAIR_PRODUCTS_INL_H
#endif

#include <bit>

#include "hwy/highway.h"
#include "splat/tile_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Multiplies the 16-bit halves of 32-bit lanes and adds up the two products of each lane.
template <class Tag>
class PairSum {
  public:
    // Both sums begin with zero, because NEON adds up neighbouring lanes of both.
    HWY_INLINE PairSum() : even_(hn::Zero(Tag())), odd_(hn::Zero(Tag())) {}
    HWY_INLINE void add(hn::Vec<Tag> a, hn::Vec<Tag> b) {
        const hn::Repartition<std::int16_t, Tag> half;
        even_ = hn::ReorderWidenMulAccumulate(Tag(), hn::BitCast(half, a), hn::BitCast(half, b),
                                              even_, odd_);
    }
    HWY_INLINE hn::Vec<Tag> total() const { return hn::RearrangeToOddPlusEven(even_, odd_); }

  private:
    hn::Vec<Tag> even_;
    hn::Vec<Tag> odd_;
};

template <class Tag>
HWY_INLINE hn::Vec<Tag> productsOfPairs(Tag, hn::Vec<Tag> a, hn::Vec<Tag> b) {
    PairSum<Tag> sum;
    sum.add(a, b);
    return sum.total();
}

// Calls use(first, last) for rows in a tile's byte and between: constants if all, to unroll.
template <typename Use>
HWY_INLINE auto forRows(unsigned rows, const Use& use) {
    return rows == 0xFF ? use(0, kTilePixels - 1)
                        : use(std::countr_zero(rows), int(std::bit_width(rows)) - 1);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
