// SPDX-License-Identifier: Apache-2.0
// Eight rows of eight 16-bit numbers become eight columns, for the kernels of each SIMD level.
#if defined(DELTASPLAT_TRANSPOSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DELTASPLAT_TRANSPOSE_INL_H_
#undef DELTASPLAT_TRANSPOSE_INL_H_
#else
#define DELTASPLAT_TRANSPOSE_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using EightShorts = hn::CappedTag<std::uint16_t, 8>;

/// Transposes 8x8 numbers: read(row) returns eight, write(column, numbers) takes them.
template <typename Read, typename Write>
HWY_INLINE void transposeEight(const Read& read, const Write& write) {
    const EightShorts tag;
    hn::Vec<EightShorts> rows[8];
    for (std::size_t i = 0; i < 8; ++i) rows[i] = read(i);
    // Rows of the first half go between those of the second one, three times.
    for (int round = 0; round < 3; ++round) {
        hn::Vec<EightShorts> mixed[8];
        for (std::size_t i = 0; i < 4; ++i) {
            mixed[2 * i] = hn::InterleaveLower(tag, rows[i], rows[i + 4]);
            mixed[2 * i + 1] = hn::InterleaveUpper(tag, rows[i], rows[i + 4]);
        }
        for (std::size_t i = 0; i < 8; ++i) rows[i] = mixed[i];
    }
    for (std::size_t i = 0; i < 8; ++i) write(i, rows[i]);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
