// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// Returns a number that is in the order of values, of a binary16, 32 or 64 pattern: negative ones
/// run backwards.
template <typename Bits>
Bits orderOfBits(Bits bits) {
    constexpr auto kSign = Bits(Bits{1} << (8 * sizeof(Bits) - 1));
    return (bits & kSign) != 0 ? Bits(~bits) : Bits(bits | kSign);
}

/// Returns the pattern of such a number; the inverse of orderOfBits.
template <typename Bits>
Bits bitsOfOrder(Bits order) {
    constexpr auto kSign = Bits(Bits{1} << (8 * sizeof(Bits) - 1));
    return (order & kSign) != 0 ? Bits(order ^ kSign) : Bits(~order);
}

/// Returns the code of a binary16 pattern.
inline Code codeOfHalfBits(std::uint16_t bits) {
    return orderOfBits(bits);
}

/// Returns the binary16 pattern of a code; the inverse of codeOfHalfBits.
inline std::uint16_t halfBitsOfCode(Code code) {
    return bitsOfOrder(code);
}

/// Returns the code nearest to `value` on the ladder offset + step * code, clamped to 0..65535;
/// 0 for NaN and for a ladder of one rung (step 0).
inline Code linearCode(double value, double offset, double step) {
    if (!(step > 0)) return 0;
    const double rung = (value - offset) / step + 0.5;
    if (!(rung >= 1)) return 0;
    return rung >= kCodeCount ? Code(kCodeCount - 1) : Code(rung);
}

/// Returns what every code stands for, [kCodeCount].
inline std::vector<double> valuesOfCodes(const CodeBook& book) {
    std::vector<double> values(kCodeCount);
    for (int code = 0; code < kCodeCount; ++code)
        values[std::size_t(code)] = book.valueOf(Code(code));
    return values;
}

/// What a voxel looks like: an index into the colours of a class table; 0 = empty.
using ClassIndex = std::uint16_t;

/// Returns how many voxels a box has; of boxes that have more than 64 bits hold, 2^63.
inline std::uint64_t voxelsOf(const IndexBox& box) {
    const glm::ivec3 d = box.dims();
    constexpr double kMost = 0x1p63;
    const double voxels = double(d.x) * double(d.y) * double(d.z);
    return voxels < kMost ? std::uint64_t(d.x) * std::uint64_t(d.y) * std::uint64_t(d.z)
                          : std::uint64_t(kMost);
}

}  // namespace deltasplat
