// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// Maps a binary16, 32 or 64 to a number that sorts like its value; negative ones run backwards.
template <typename Bits>
Bits orderOfBits(Bits bits) {
    constexpr auto kSign = Bits(Bits{1} << (8 * sizeof(Bits) - 1));
    return (bits & kSign) != 0 ? Bits(~bits) : Bits(bits | kSign);
}

/// Inverse of orderOfBits.
template <typename Bits>
Bits bitsOfOrder(Bits order) {
    constexpr auto kSign = Bits(Bits{1} << (8 * sizeof(Bits) - 1));
    return (order & kSign) != 0 ? Bits(order ^ kSign) : Bits(~order);
}

inline Code codeOfHalfBits(std::uint16_t bits) {
    return orderOfBits(bits);
}

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

/// Returns the value of every code, [kCodeCount].
inline std::vector<double> valuesOfCodes(const CodeBook& book) {
    std::vector<double> values(kCodeCount);
    for (int code = 0; code < kCodeCount; ++code)
        values[std::size_t(code)] = book.valueOf(Code(code));
    return values;
}

/// The look of a voxel: an index into the colours of a class table; 0 = empty.
using ClassIndex = std::uint16_t;

/// Returns the number of voxels in a box; 2^63 if the number does not fit into 64 bits.
inline std::uint64_t voxelsOf(const IndexBox& box) {
    const glm::ivec3 d = box.dims();
    constexpr double kMost = 0x1p63;
    const double voxels = double(d.x) * double(d.y) * double(d.z);
    return voxels < kMost ? std::uint64_t(d.x) * std::uint64_t(d.y) * std::uint64_t(d.z)
                          : std::uint64_t(kMost);
}

}  // namespace deltasplat
