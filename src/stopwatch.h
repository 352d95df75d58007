// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace deltasplat {

using Clock = std::chrono::steady_clock;

/// Returns the wall-clock seconds that have passed since `start`.
inline double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace deltasplat
