// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

#include "base/text.h"

namespace deltasplat {

/// What a float is rounded by at most, as a share of it.
inline constexpr double kFloatRounding = 0x1p-24;

/// Returns the number with as few digits as keep it within a share of itself, for people to read.
inline std::string shortNumberText(double number, double share = kFloatRounding) {
    constexpr int kMostDigits = 17;
    if (number == 0) return "0";  // whatever its sign
    for (int digits = 1; digits < kMostDigits; ++digits) {
        char text[32];
        char* const end =
            std::to_chars(text, text + sizeof text, number, std::chars_format::general, digits).ptr;
        double read = 0;
        const bool isRead = std::from_chars(text, end, read).ec == std::errc();
        if (isRead && std::abs(read - number) <= share * std::abs(number)) return numberText(read);
    }
    return numberText(number);
}

}  // namespace deltasplat
