// SPDX-License-Identifier: Apache-2.0
// What is done with eight voxels of rows that are joined, for the kernels of each SIMD level.
#if defined(DELTASPLAT_JOINED_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DELTASPLAT_JOINED_ROWS_INL_H_
#undef DELTASPLAT_JOINED_ROWS_INL_H_
#else
#define DELTASPLAT_JOINED_ROWS_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "hwy/highway.h"
#include "words/joined_rows.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Whether any of eight voxels is visible in any slice.
/// @param first  place of the first voxel in each slice
HWY_INLINE bool anyClass(const JoinedRows& rows, std::size_t first) {
    const hn::CappedTag<std::uint16_t, 8> tag;
    auto any = hn::Zero(tag);
    for (std::size_t slice = 0; slice < rows.count; ++slice)
        for (std::size_t v = 0; v < 8; v += hn::Lanes(tag))
            any = hn::Or(any, hn::LoadU(tag, rows.slices[slice] + first + v));
    return !hn::AllTrue(tag, hn::Eq(any, hn::Zero(tag)));
}

/// Numbers eight pairs of voxels: `first * classCount + second`.
HWY_INLINE void numberPairs(const ClassIndex* first, const ClassIndex* second,
                            std::size_t classCount, ClassIndex* HWY_RESTRICT out) {
    const hn::CappedTag<std::uint16_t, 8> tag;
    const auto count = hn::Set(tag, std::uint16_t(classCount));
    for (std::size_t v = 0; v < 8; v += hn::Lanes(tag)) {
        const auto pair = hn::Mul(hn::LoadU(tag, first + v), count);
        hn::StoreU(hn::Add(pair, hn::LoadU(tag, second + v)), tag, out + v);
    }
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
