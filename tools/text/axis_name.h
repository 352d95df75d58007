// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace deltasplat {

/// Returns "x", "y" or "z" for 0, 1 or 2.
inline std::string axisName(int axis) {
    return std::string(1, char('x' + axis));
}

}  // namespace deltasplat
