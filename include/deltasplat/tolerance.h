// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// Largest error of a voxel against its source, by both limits; both 0: exact. Empty stays empty.
struct Tolerance {
    double relative = 0;  ///< share of the true value's magnitude, >= 0
    double value = 0;     ///< in data units, >= 0

    bool isExact() const { return relative == 0 && value == 0; }
};

}  // namespace deltasplat
