// SPDX-License-Identifier: Apache-2.0
// Inner loop for reading small integers, compiled once per SIMD level.
#include "formats/raw/raw_kernels.h"

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "formats/raw/raw_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "base/transpose-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <typename T>
HWY_INLINE hn::Vec<EightShorts> loadEight(const std::byte* row) {
    const EightShorts tag;
    if constexpr (sizeof(T) == 2) {
        // The row may be unaligned.
        const hn::Repartition<std::uint8_t, EightShorts> bytes;
        return hn::BitCast(tag, hn::LoadU(bytes, reinterpret_cast<const std::uint8_t*>(row)));
    } else {
        const hn::Rebind<T, EightShorts> from;
        const auto numbers = hn::LoadU(from, reinterpret_cast<const T*>(row));
        if constexpr (std::is_signed_v<T>) {
            return hn::BitCast(tag, hn::PromoteTo(hn::RebindToSigned<EightShorts>(), numbers));
        } else {
            return hn::PromoteTo(tag, numbers);
        }
    }
}

template <typename T>
HWY_INLINE void encode(const RawBlock& block, Code offset, Code* HWY_RESTRICT codes) {
    const EightShorts tag;
    const auto less = hn::Set(tag, offset);
    for (std::size_t y = 0; y < 8; ++y) {
        const std::byte* rows = block.first + y * block.rowBytes;
        const auto read = [&](std::size_t z) {
            return hn::Sub(loadEight<T>(rows + z * block.sliceBytes), less);
        };
        transposeEight(read, [&](std::size_t x, hn::Vec<EightShorts> column) {
            hn::StoreU(column, tag, codes + 64 * x + 8 * y);
        });
    }
}

void encodeWholeBlockKernel(const RawBlock& block, RawType type, Code offset, Code* codes) {
    switch (type) {
        case RawType::kUint8:
            return encode<std::uint8_t>(block, offset, codes);
        case RawType::kInt8:
            return encode<std::int8_t>(block, offset, codes);
        default:
            // Signed numbers have the same bits.
            return encode<std::uint16_t>(block, offset, codes);
    }
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(encodeWholeBlockKernel);

void encodeWholeBlock(const RawBlock& block, RawType type, Code offset, Code* codes) {
    HWY_DYNAMIC_DISPATCH(encodeWholeBlockKernel)(block, type, offset, codes);
}

}  // namespace deltasplat
#endif
