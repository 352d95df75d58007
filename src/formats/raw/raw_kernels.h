// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/raw/raw_values.h"

namespace deltasplat {

/// Writes the codes of a whole block of 8x8x8 integers of 8 or 16 bits in native byte order, like
/// EncodeBlock: the low 16 bits of number minus offset.
void encodeWholeBlock(const RawBlock& block, RawType type, Code offset, Code* codes);

}  // namespace deltasplat
