// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "deltasplat/ingest/code_book.h"

namespace deltasplat {

/// Returns the code of a binary16 pattern: negative patterns run backwards, so that codes are in
/// the order of values.
inline Code codeOfHalfBits(std::uint16_t bits) {
    return (bits & 0x8000) != 0 ? Code(~bits) : Code(bits | 0x8000);
}

/// Returns the binary16 pattern of a code; the inverse of codeOfHalfBits.
inline std::uint16_t halfBitsOfCode(Code code) {
    return (code & 0x8000) != 0 ? std::uint16_t(code & 0x7fff) : std::uint16_t(~code);
}

/// Returns the code nearest to `value` on the ladder offset + step * code, clamped to 0..65535;
/// 0 for NaN and for a ladder of one rung (step 0).
inline Code linearCode(double value, double offset, double step) {
    if (!(step > 0)) return 0;
    const double rung = (value - offset) / step + 0.5;
    if (!(rung >= 1)) return 0;
    return rung >= kCodeCount ? Code(kCodeCount - 1) : Code(rung);
}

}  // namespace deltasplat
