// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace deltasplat {

/// 1, 2 or 5 times a power of ten.
struct NiceStep {
    int factor = 1;
    int exponent = 0;

    /// Returns the multiple as it is written in decimals: 3 steps of 0.1 are 0.3 to the last bit.
    double times(std::int64_t count) const {
        const std::string text = std::to_string(count * factor) + "e" + std::to_string(exponent);
        double value = 0;
        std::from_chars(text.data(), text.data() + text.size(), value);
        return value;
    }
};

/// Returns the largest of 1, 2 and 5 times a power of ten that divides a finite `span` > 0 at least
/// `parts` times.
inline NiceStep niceStepOf(double span, int parts) {
    // Logarithms are not the same to the last bit everywhere.
    char text[32];
    const char* const end =
        std::to_chars(text, text + sizeof text, span / parts, std::chars_format::scientific).ptr;
    const std::string digits(text, std::size_t(end - text));
    NiceStep step{1, std::stoi(digits.substr(digits.find('e') + 1))};
    for (const int factor : {5, 2}) {
        if (span / NiceStep{factor, step.exponent}.times(1) >= parts)
            return {factor, step.exponent};
    }
    return step;
}

/// Returns it as a number; of an infinite span that.
inline double niceStep(double span, int parts) {
    return std::isfinite(span) ? niceStepOf(span, parts).times(1) : span;
}

/// Returns the multiples of a nice step from `low` to `high` > `low`, which it divides at least
/// `parts` times; none where numbers are too large for their distance.
inline std::vector<double> niceTicks(double low, double high, int parts) {
    std::vector<double> ticks;
    if (!std::isfinite(high - low)) return ticks;
    const NiceStep step = niceStepOf(high - low, parts);
    const double first = std::ceil(low / step.times(1));
    constexpr double kMostCount = 1e15;
    if (!(std::abs(first) < kMostCount)) return ticks;
    // Quotients may be rounded across a whole number.
    for (auto count = std::int64_t(first) - 1; step.times(count) <= high; ++count) {
        if (step.times(count) >= low) ticks.push_back(step.times(count) + 0.0);
    }
    return ticks;
}

}  // namespace deltasplat
