// SPDX-License-Identifier: Apache-2.0
// Decodes numbers from planes of bits, compiled once per SIMD level.
#include "formats/delta/plane_kernels.h"

#include <algorithm>
#include <array>
#include <bit>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "formats/delta/plane_kernels.cpp"
#include "hwy/foreach_target.h"
// Highway requires this order: after foreach_target.h.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Planes are read as bytes.
static_assert(std::endian::native == std::endian::little);

// Bits of 64 numbers. One extra plane, because Highway reads masks of 8 bytes.
template <std::size_t kMost>
using Planes = std::array<std::uint64_t, kMost + 1>;

// Moves the lowest bits to the ones of a mask, in order.
HWY_INLINE std::uint64_t deposit(std::uint64_t bits, std::uint64_t mask) {
#if HWY_ARCH_X86_64 && HWY_TARGET <= HWY_AVX2 && !defined(HWY_DISABLE_BMI2_FMA)
    return _pdep_u64(bits, mask);
#else
    std::uint64_t put = 0;
    for (; mask != 0; mask &= mask - 1, bits >>= 1) put |= mask & (0 - mask) & (0 - (bits & 1));
    return put;
#endif
}

// Adds up planes to 64 bytes. All planes weigh the same, or each weighs twice the one before.
template <bool kAreEqual>
HWY_INLINE void addPlanes(const std::uint64_t* planes, int count, std::uint8_t* HWY_RESTRICT sums) {
    const hn::CappedTag<std::uint8_t, 64> tag;
    for (std::size_t n = 0; n < 64; n += hn::Lanes(tag)) {
        auto sum = hn::Zero(tag);
        auto worth = hn::Set(tag, std::uint8_t{1});
        for (int i = 0; i < count; ++i) {
            const auto* const bits = reinterpret_cast<const std::uint8_t*>(planes + i) + n / 8;
            sum = hn::Add(sum, hn::IfThenElseZero(hn::LoadMaskBits(tag, bits), worth));
            if constexpr (!kAreEqual) worth = hn::Add(worth, worth);
        }
        hn::Store(sum, tag, sums + n);
    }
}

template <typename Number>
HWY_INLINE std::uint64_t takeNumbers(BitReader& in, RiceCode code, int parameter, std::size_t count,
                                     Number* HWY_RESTRICT numbers) {
    // Numbers with a quotient of at least 1, at least 2, ...
    Planes<RiceCode::kMostOnes> quotients;
    std::uint64_t larger = in.take(int(count));
    std::uint64_t any = larger;
    quotients[0] = larger;
    int levels = 1;
    while (larger != 0 && levels < RiceCode::kMostOnes) {
        const int asked = std::popcount(larger);
        larger = deposit(in.peek(), larger);
        in.skip(asked);
        quotients[std::size_t(levels++)] = larger;
    }
    Planes<64> remainders;
    for (int bit = 0; bit < parameter; ++bit) {
        const std::uint64_t plane = in.take(int(count));
        remainders[std::size_t(bit)] = plane;
        any |= plane;
    }

    HWY_ALIGN std::uint8_t bytes[64];
    HWY_ALIGN std::uint8_t lowest[64];
    addPlanes<true>(quotients.data(), levels, bytes);
    addPlanes<false>(remainders.data(), std::min(parameter, 8), lowest);
    for (std::size_t n = 0; n < 64; ++n)
        numbers[n] = Number(Number(bytes[n]) << parameter | lowest[n]);
    for (int bit = 8; bit < parameter; bit += 8) {
        addPlanes<false>(remainders.data() + bit, std::min(parameter - bit, 8), bytes);
        for (std::size_t n = 0; n < 64; ++n) numbers[n] |= Number(bytes[n]) << bit;
    }
    // Numbers too large for a quotient. Damaged ones may be 0 all the same.
    for (; larger != 0; larger &= larger - 1) {
        const int n = std::countr_zero(larger);
        numbers[n] = Number((numbers[n] & BitReader::lowBits(parameter)) |
                            in.take(code.width - parameter) << parameter);
        if (numbers[n] == 0) any &= ~(std::uint64_t{1} << n);
    }
    // So may numbers whose shifted quotient overflows.
    constexpr int kBits = int(8 * sizeof(Number));
    for (std::size_t n = 0; parameter > kBits - 4 && n < 64; ++n)
        if (numbers[n] == 0) any &= ~(std::uint64_t{1} << n);
    return any;
}

std::uint64_t takePlanesKernel(BitReader& in, RiceCode code, int parameter, std::size_t count,
                               std::uint32_t* numbers) {
    return takeNumbers(in, code, parameter, count, numbers);
}

std::uint64_t takeWidePlanesKernel(BitReader& in, RiceCode code, int parameter, std::size_t count,
                                   std::uint64_t* numbers) {
    return takeNumbers(in, code, parameter, count, numbers);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(takePlanesKernel);
HWY_EXPORT(takeWidePlanesKernel);

std::uint64_t takePlanes(BitReader& in, RiceCode code, int parameter, std::size_t count,
                         std::uint32_t* numbers) {
    return HWY_DYNAMIC_DISPATCH(takePlanesKernel)(in, code, parameter, count, numbers);
}

std::uint64_t takePlanes(BitReader& in, RiceCode code, int parameter, std::size_t count,
                         std::uint64_t* numbers) {
    return HWY_DYNAMIC_DISPATCH(takeWidePlanesKernel)(in, code, parameter, count, numbers);
}

}  // namespace deltasplat
#endif
