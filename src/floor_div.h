// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// Returns a / b rounded down, for b > 0.
constexpr int floorDiv(int a, int b) {
    return a / b - (a % b != 0 && a < 0);
}

}  // namespace deltasplat
