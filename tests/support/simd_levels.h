// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "deltasplat/simd.h"

namespace deltasplat::test {

/// Whether this is compiled for a sanitizer, under which everything takes many times as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

/// Returns the SIMD levels to be tried: all that there are. Under a sanitizer without the one for
/// any processor, if there are others: there it takes twenty times as long as they do, and touches
/// the same memory as the other level of four lanes.
inline std::vector<std::string> testedSimdLevels() {
    std::vector<std::string> levels = simdLevels();
    if (kIsSanitized && levels.size() > 1) std::erase(levels, "EMU128");
    return levels;
}

/// Calls use() at each of these levels.
template <typename Use>
void atEveryLevel(const Use& use) {
    for (const std::string& level : testedSimdLevels()) {
        SCOPED_TRACE(level);
        setSimdLevel(level);
        use();
    }
    setSimdLevel("auto");
}

}  // namespace deltasplat::test
