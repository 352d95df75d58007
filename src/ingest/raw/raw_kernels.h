// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "ingest/raw/raw_values.h"

namespace deltasplat {

/// Writes the codes of a whole block of 8x8x8 whole numbers of 8 or 16 bits, in the machine's byte
/// order, as EncodeBlock does: the low 16 bits of each, less those of the offset.
void encodeWholeBlock(const RawBlock& block, RawType type, Code offset, Code* codes);

/// Returns the smallest and the largest code of such a block.
/// @param offset  the low 16 bits of the least number that the type has
std::pair<Code, Code> rangeOfWholeBlock(const RawBlock& block, RawType type, Code offset);

}  // namespace deltasplat
