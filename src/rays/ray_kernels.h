// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace deltasplat {

/// Some slices of a volume as floats, `[slices][sizeU][sizeV]`, and four values more, around lines
/// of sight that go towards larger positions along every axis.
struct RayPatch {
    const float* values = nullptr;
    /// Likewise 1 where a voxel is active, else 0; null: all are, or nobody asks.
    const float* active = nullptr;
    std::ptrdiff_t sliceStep = 0;
    int slices = 0;
    int sizeU = 0;
    int sizeV = 0;
    /// Of largest values: what is not active, where `values` is 0, has no part in what is read,
    /// which is the mean of the others by their weights.
    bool leavesOut = false;
    /// Of largest values: `[slices - 1][topsU][topsV]`, the largest value that can be read between
    /// two slices from any of kTopCell x kTopCell first voxels on.
    const float* tops = nullptr;
    int topsU = 0;
    int topsV = 0;
};

inline constexpr int kTopCell = 4;

/// Lines of sight side by side, and what they have found so far. Positions are whole voxels from a
/// patch's first, and how far behind these: bits do not depend on where a patch begins.
struct RayRun {
    /// The numbers of those bundles of kRayBundle lines that are followed.
    const std::size_t* bundles;
    std::size_t count;  ///< of bundles
    /// Where lines meet the first slice.
    const std::int32_t* wholeU;
    const std::int32_t* wholeV;
    const float* u;
    const float* v;
    const float* slopeU;  ///< voxels along u for each slice, 0 to 1
    const float* slopeV;
    const float* firstSlice;  ///< the first that counts; of largest values also between slices
    float* found;             ///< the sum, or the largest value
    float* rest;              ///< how much a sum is too large; where a largest value is, in slices
    float* met;               ///< of largest values: 1 where an active voxel has been met, else 0
    float depth = 0;          ///< the first slice's, that places are counted on from
    /// Of means: as `found` and `rest`, the sum of 1 where voxels are active; else null.
    float* share = nullptr;
    float* shareRest = nullptr;
};

inline constexpr std::size_t kRayBundle = 8;

/// Adds what lines of sight have of each slice: the integral of its share in a trilinear
/// interpolation of the values, from the slice before to the slice behind it, in slices. It is
/// exact but for rounding, and what rounding adds to a sum is taken off with the next slice.
/// Multiplications and additions are separate and per line, so that every SIMD level gives the same
/// bits.
void sumSlices(const RayPatch& patch, const RayRun& rays);

/// Places that are read on the way from one slice to the next.
inline constexpr int kRaySteps = 6;

/// Keeps the largest of what lines of sight read, trilinearly, from the patch's first slice to its
/// last.
void maxSlices(const RayPatch& patch, const RayRun& rays);

}  // namespace deltasplat
