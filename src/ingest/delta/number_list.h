// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <vector>

namespace deltasplat {

/// Returns numbers as text with one space between, each the shortest that reads back the same.
template <typename Number>
std::string listText(const std::vector<Number>& numbers) {
    std::string text;
    for (const Number number : numbers) {
        char digits[32];
        if (!text.empty()) text += ' ';
        text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
    }
    return text;
}

/// Reads what listText writes; empty if the text is anything else.
template <typename Number>
std::optional<std::vector<Number>> parseList(const std::string& text) {
    std::vector<Number> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at != end) {
        Number number{};
        const auto [next, problem] = std::from_chars(at, end, number);
        if (problem != std::errc() || (next != end && (*next != ' ' || next + 1 == end))) return {};
        numbers.push_back(number);
        at = next == end ? end : next + 1;
    }
    return numbers;
}

}  // namespace deltasplat
