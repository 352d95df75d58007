// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "deltasplat/ingest/code_book.h"

namespace deltasplat {

/// Returns the smallest and the largest of at least one code.
std::pair<Code, Code> rangeOfCodes(std::span<const Code> codes);
std::pair<Code, Code> rangeOfCodes(std::span<const std::uint8_t> codes);

inline constexpr std::size_t kMostFewCodes = 64;
using FewCounts = std::array<std::uint32_t, kMostFewCodes>;

/// Counts each of the codes `lowest` .. `highest`, among which all `codes` are, if that is fast.
/// @param counts  receives how often `lowest` + n occurs
/// @return the number of counts; 0 if there are too many, or codes are no whole number of vectors
std::size_t countFewCodes(std::span<const Code> codes, Code lowest, Code highest,
                          FewCounts& counts);
std::size_t countFewCodes(std::span<const std::uint8_t> codes, Code lowest, Code highest,
                          FewCounts& counts);

}  // namespace deltasplat
