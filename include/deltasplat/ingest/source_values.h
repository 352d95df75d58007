// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace deltasplat {

struct FrequentValue {
    double value = 0;
    std::uint64_t count = 0;
};

/// Error of codes against the source's values, over every active voxel.
struct CodeError {
    double absolute = 0;  ///< largest difference, in data units
    /// Largest difference relative to the value's magnitude; for values small against the bulk,
    /// relative to 0.076 times the bulk's width, of which 2e-4 is 2^-16 of the width.
    double relative = 0;
};

}  // namespace deltasplat
