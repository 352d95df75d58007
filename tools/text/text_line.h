// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace deltasplat {

/// Returns a line of a report for people, "  label         value", values below each other.
inline std::string textLine(const std::string& label, const std::string& value) {
    constexpr std::size_t kWidth = 14;
    return "  " + label + std::string(label.size() < kWidth ? kWidth - label.size() : 1, ' ') +
           value + "\n";
}

}  // namespace deltasplat
