// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "reference/reference_renderer.h"

/// What a line of sight meets of values that are interpolated trilinearly, in double precision: cut
/// where it crosses a plane of voxels of any axis, between which all is a polynomial.
namespace reference {

/// Values on a lattice; what is not active, and what lies around it, holds nothing.
struct ValueVolume {
    std::array<int, 3> first{};  ///< index of the first voxel, may be negative
    std::array<int, 3> dims{};
    std::vector<double> values;  ///< [z][y][x]
    std::vector<bool> active;    ///< likewise
    std::array<Vector, 3> axes{};
    Vector origin{};
};

struct Seen {
    /// Of the values, in world units; nothing counts as 0.
    double integral = 0;
    /// Nothing counts as the smallest value there is, if that is negative, else as 0.
    double highest = 0;
    /// Of means of the active ones, by their weights; and the mean of all that is met.
    double lowest = 0, mean = 0;
    bool met = false;
};

/// Follows one.
/// @param from, ray  in voxels; it begins at `from + nearest * ray`
/// @param between    how many places are read for the highest and the lowest between two planes
Seen followLine(const ValueVolume& volume, const Vector& from, const Vector& ray, double nearest,
                int between = 32);

/// Follows parallel ones through the middles of pixels.
std::vector<Seen> parallelLines(const ValueVolume& volume, const View& view, int between = 32);

/// The largest that is read at places `step` world units apart, the first of them at a share of
/// that behind where a line meets the volume.
std::vector<double> marchedHighest(const ValueVolume& volume, const View& view, double step,
                                   double share = 0.5);

}  // namespace reference
