// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// How far a voxel's value may be from its source's. Both 0: not at all; both given: neither may be
/// exceeded. What is empty stays empty.
struct Tolerance {
    double relative = 0;  ///< share of the true value's magnitude, >= 0
    double value = 0;     ///< in data units, >= 0

    bool isExact() const { return relative == 0 && value == 0; }
};

}  // namespace deltasplat
