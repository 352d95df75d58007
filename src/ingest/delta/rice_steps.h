// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace deltasplat {

/// The numbers that lie, as a whole, in the next bits of a stream of Rice codes, one behind the
/// other.
struct RiceStep {
    static constexpr int kLookedAt = 11;  ///< bits
    static constexpr int kMostNumbers = 4;

    std::array<std::uint8_t, kMostNumbers> numbers{};
    std::uint16_t count = 0;  ///< 0: the first number does not end within these bits
    std::uint16_t bits = 0;   ///< that they take
};

/// Returns the steps for each value of the next bits, or null for parameters of which most codes
/// are too long. Thread-safe.
const RiceStep* riceSteps(int parameter);

}  // namespace deltasplat
