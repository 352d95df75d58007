// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "deltasplat/ingest/code_book.h"

namespace deltasplat {

/// Turns codes into values.
struct CodeValues {
    const float* table = nullptr;  ///< [kCodeCount]
    float offset = 0;              ///< value = code + offset, if `direct`
    bool direct = false;           ///< if exact, and faster than the table
};

/// Destination of an 8x8x8 block's values: [slice][u][v], eight values along v side by side.
struct ValuePlace {
    float* first;
    std::size_t sliceStep;
    std::size_t rowStep;
    int firstSlice = 0;  ///< first wanted slice
    int lastSlice = 7;
};

/// Reads the 512 codes of a leaf (x slowest, z fastest) as values, in (slice, u, v) order.
void readBlockValues(const Code* codes, int sliceAxis, const CodeValues& values,
                     const ValuePlace& place);

}  // namespace deltasplat
