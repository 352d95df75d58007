// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/raw/raw_values.h"

namespace deltasplat {

/// Writes the codes of a whole block of 8x8x8 whole numbers of 8 or 16 bits, in the machine's byte
/// order, as EncodeBlock does: the low 16 bits of each, less those of the offset.
void encodeWholeBlock(const RawBlock& block, RawType type, Code offset, Code* codes);

}  // namespace deltasplat
