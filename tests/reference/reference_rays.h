// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "reference/reference_renderer.h"

/// Line integrals and largest values in double precision, one slice and one sample after the other.
namespace reference {

/// Values on a lattice; what is not active holds nothing.
struct ValueVolume {
    std::array<int, 3> first{};  ///< index of the first voxel, may be negative
    std::array<int, 3> dims{};
    std::vector<double> values;  ///< [z][y][x]
    std::vector<bool> active;    ///< likewise
    std::array<Vector, 3> axes{};
    Vector origin{};
};

/// What a pixel sees.
struct Seen {
    double value = 0;
    double share = 0;  ///< how much of the pixel is met by active voxels, 0..1 but for the filter
};

/// Adds up all slices at the voxel positions of the first one, each read bilinearly where the line
/// of sight goes through it, times the world distance between slices; then weighs neighbours with a
/// Gaussian of covariance sigma^2 (I + d d^T). Seen through a quintic B-spline;
/// the picture must be at least as fine as the voxels. The share is 0.
std::vector<Seen> lineIntegrals(const ValueVolume& volume, const View& view, double sigma);

/// Takes the largest instead. What is not active counts as the smallest value there is, if that is
/// negative, else as 0; positions at which no active voxel is read do not count at all.
std::vector<Seen> largestValues(const ValueVolume& volume, const View& view);

/// Takes the smallest. What is read is the mean of the active voxels, by their weights.
std::vector<Seen> smallestValues(const ValueVolume& volume, const View& view);

}  // namespace reference
