// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

namespace deltasplat {

/// The table of integer weights that one voxel stamps into the sheet: the kernel integrated along
/// the line of sight. Sheet pixels lie at voxel centres and at the r - 1 places between them, so
/// that every voxel has the same phase and one table serves the whole volume.
struct Footprint {
    static constexpr std::int32_t kOne = 32768;  ///< what the weights of one phase add up to

    int resolution = 1;  ///< r: sheet pixels a voxel
    int radius = 0;      ///< sheet pixels from the middle to the edge
    /// `[width()][width()]`, rows along v, columns along u, middle at (radius, radius). None is
    /// negative. For each of the r * r phases (places modulo r), the weights add up to exactly
    /// kOne: a constant slice gives a constant sheet.
    std::vector<std::int32_t> weights;

    int width() const { return 2 * radius + 1; }
    std::int32_t at(int u, int v) const { return weights[v * width() + u]; }
};

inline constexpr double kMinSigma = 0.2;
inline constexpr double kMaxSigma = 4.0;

/// Returns the width used when none is asked for: 0.3 voxels, which is sharpest, or 0.4 where a
/// voxel covers three pixels or more and would begin to show as a square.
/// @param resolution  r, sheet pixels a voxel
inline double defaultSigma(int resolution) {
    return resolution <= 2 ? 0.3 : 0.4;
}

/// Makes the Gaussian footprint with covariance sigma^2 (I + d d^T) in slice units: a round kernel
/// seen along the line of sight. Cut off where less than `kFootprintTail` of it is left outside.
/// @param sigmaVoxels    kMinSigma..kMaxSigma
/// @param shiftPerSlice  d, |d| <= 1 in each component
/// @param resolution     r, at least 1
/// @throw Error(kUsage) if sigma is out of range
Footprint makeFootprint(double sigmaVoxels, glm::dvec2 shiftPerSlice, int resolution);
inline constexpr double kFootprintTail = 0.002;

}  // namespace deltasplat
