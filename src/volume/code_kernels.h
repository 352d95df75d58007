// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "deltasplat/ingest/code_book.h"

namespace deltasplat {

/// Returns the smallest and the largest of some codes, at least one.
std::pair<Code, Code> rangeOfCodes(std::span<const Code> codes);
std::pair<Code, Code> rangeOfCodes(std::span<const std::uint8_t> codes);

inline constexpr std::size_t kMostFewCodes = 64;
using FewCounts = std::array<std::uint32_t, kMostFewCodes>;

/// Counts how many of some codes are `lowest`, `lowest` + 1 .. `highest`, which all of them lie
/// between, where that is quicker than to count one by one.
/// @param counts  becomes how often each occurs
/// @return of how many numbers; 0 if these are too many, or codes no whole vectors
std::size_t countFewCodes(std::span<const Code> codes, Code lowest, Code highest,
                          FewCounts& counts);
std::size_t countFewCodes(std::span<const std::uint8_t> codes, Code lowest, Code highest,
                          FewCounts& counts);

}  // namespace deltasplat
