// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cstdint>

#include "diff/voxel_source.h"

namespace deltasplat {

/// What is the same for all voxels of a comparison.
struct ErrorTerms {
    WideValue backgroundA;
    WideValue backgroundB;
    double fail = 0;
    double warn = 0;
    bool wide = false;  ///< as VoxelSource
};

/// Returns |a - b|: 0 if they are equal (NaN equals NaN), never more than the largest double.
double errorOf(const WideValue& a, const WideValue& b);

/// Errors of some voxels, added up. The sums depend on the order of the additions, so that is to be
/// fixed.
struct ErrorSums {
    std::uint64_t voxels = 0;  ///< compared ones
    std::uint64_t overFail = 0;
    std::uint64_t overWarn = 0;
    std::uint64_t activeMismatch = 0;
    /// Beyond the range of a double, where long double allows: squares of errors are.
    long double sum = 0;
    long double sumOfSquares = 0;
    double max = 0;
    openvdb::Coord maxAt{0, 0, 0};
    WideValue maxA;
    WideValue maxB;

    /// Adds `count` voxels that are alike, the first of them at `first`.
    void addTile(const Sample& a, const Sample& b, const openvdb::Coord& first, std::uint64_t count,
                 const ErrorTerms& terms);
    /// Adds the block whose first voxel is `origin`.
    void addBlock(const BlockSamples& a, const BlockSamples& b, const openvdb::Coord& origin,
                  const ErrorTerms& terms);
    void append(const ErrorSums& other);

  private:
    void addMax(double error, const openvdb::Coord& at, const WideValue& a, const WideValue& b);
};

}  // namespace deltasplat
