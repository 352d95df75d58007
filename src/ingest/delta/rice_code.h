// SPDX-License-Identifier: Apache-2.0
// Based on: Robert Rice, "Some Practical Universal Noiseless Coding Techniques", 1979. Here a
// quotient has a limit, behind which a number stands as it is.
#pragma once

namespace deltasplat {

/// How numbers of one kind are written: as a quotient in ones, a zero, and a remainder of as many
/// bits as the parameter says; or, where there would be kMostOnes ones, as those and all its bits.
/// Their bits lie in planes (plane_kernels.h).
struct RiceCode {
    static constexpr int kMostOnes = 8;

    int width = 32;  ///< bits of the largest number

    /// Bits of a parameter.
    int parameterBits() const { return width > 32 ? 6 : 5; }
};

}  // namespace deltasplat
