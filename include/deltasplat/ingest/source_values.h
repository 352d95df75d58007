// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace deltasplat {

/// A value that many voxels have.
struct FrequentValue {
    double value = 0;
    std::uint64_t count = 0;  ///< voxels that have it
};

/// How far codes are from the values of the source, measured over every active voxel.
struct CodeError {
    double absolute = 0;  ///< largest difference, in data units
    /// Largest difference as a share of the value's magnitude; of values that are small beside the
    /// bulk of all, as a share of 0.076 times the bulk's width, of which 2^-16 of it is 2e-4.
    double relative = 0;
};

}  // namespace deltasplat
