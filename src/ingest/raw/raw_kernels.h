// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "ingest/raw/raw_values.h"

namespace deltasplat {

/// Writes the codes of a whole block of 8x8x8 small whole numbers, as EncodeBlock does: the low 16
/// bits of each, less those of the offset.
template <typename T>
void encodeWholeBlock(const RawBlock& block, Code offset, Code* codes) = delete;
template <>
void encodeWholeBlock<std::uint8_t>(const RawBlock& block, Code offset, Code* codes);
template <>
void encodeWholeBlock<std::int8_t>(const RawBlock& block, Code offset, Code* codes);
template <>
void encodeWholeBlock<std::uint16_t>(const RawBlock& block, Code offset, Code* codes);
template <>
void encodeWholeBlock<std::int16_t>(const RawBlock& block, Code offset, Code* codes);

}  // namespace deltasplat
