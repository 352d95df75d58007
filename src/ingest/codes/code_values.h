// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "deltasplat/ingest/code_book.h"

namespace deltasplat {

/// Returns what every code stands for, [kCodeCount].
inline std::vector<double> valuesOfCodes(const CodeBook& book) {
    std::vector<double> values(kCodeCount);
    for (int code = 0; code < kCodeCount; ++code)
        values[std::size_t(code)] = book.valueOf(Code(code));
    return values;
}

}  // namespace deltasplat
