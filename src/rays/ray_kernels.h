// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace deltasplat {

/// Some slices of a volume as floats, `[slices][sizeU][sizeV]`, and four spare values. Lines of
/// sight go towards larger positions along every axis.
struct RayPatch {
    const float* values = nullptr;
    /// Likewise 1 where a voxel is active, else 0; null: all are active, or it does not matter.
    const float* active = nullptr;
    std::ptrdiff_t sliceStep = 0;
    int slices = 0;
    int sizeU = 0;
    int sizeV = 0;
    /// Largest values: read the weighted mean of active voxels only; inactive `values` are 0.
    bool leavesOut = false;
    /// Largest values: `[slices - 1][topsU][topsV]`, the largest value that can be read between two
    /// slices from any of kTopCell x kTopCell first voxels on.
    const float* tops = nullptr;
    int topsU = 0;
    int topsV = 0;
};

inline constexpr int kTopCell = 4;

/// Lines of sight side by side, and their results so far. A position is a number of whole voxels
/// from a patch's first and a remainder, so bits do not depend on where a patch begins.
struct RayRun {
    /// Numbers of the bundles, of kRayBundle lines, to follow.
    const std::size_t* bundles;
    std::size_t count;  ///< of bundles
    /// Where lines meet the first slice.
    const std::int32_t* wholeU;
    const std::int32_t* wholeV;
    const float* u;
    const float* v;
    const float* slopeU;  ///< voxels along u per slice, 0 to 1
    const float* slopeV;
    const float* firstSlice;  ///< first that counts; for largest values also between slices
    float* found;             ///< the sum, or the largest value
    float* rest;              ///< excess of the sum; or place of the largest value, in slices
    float* met;               ///< largest values: 1 where an active voxel has been met, else 0
    float depth = 0;          ///< of the first slice; places count on from it
    /// For means, like `found` and `rest`: sum of 1 where voxels are active; else null.
    float* share = nullptr;
    float* shareRest = nullptr;
};

inline constexpr std::size_t kRayBundle = 8;

/// Adds each slice's part of lines of sight: the integral, in slices, of its share in a trilinear
/// interpolation from the slice before to the slice behind. Exact but for rounding; rounding errors
/// of a sum are subtracted with the next slice. Multiplications and additions are separate and per
/// line, so every SIMD level gives the same bits.
void sumSlices(const RayPatch& patch, const RayRun& rays);

/// Places read from one slice to the next.
inline constexpr int kRaySteps = 6;

/// Keeps the largest trilinearly read value from the patch's first slice to its last.
void maxSlices(const RayPatch& patch, const RayRun& rays);

}  // namespace deltasplat
