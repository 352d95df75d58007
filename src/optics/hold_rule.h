// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <optional>

#include "deltasplat/optics/class_table.h"
#include "deltasplat/tolerance.h"
#include "optics/voxel_painter.h"
#include "optics/voxel_units.h"

namespace deltasplat {

/// Returns the rule by which a voxel may keep its slot from the slice before (PackOptions::holds):
/// every classified channel is within `relative` times the true channel, and the value within
/// `value` of the true value. Empty if the tolerance is exact. Refers to `classes`.
/// @throw Error(kUsage) if `relative` is not within [0, 1) or `value` is negative or not finite
std::function<bool(Slot held, Slot slot)> holdRule(const Volume& volume, const ClassTable& classes,
                                                   const Tolerance& tolerance);

/// The same rule for voxels whose looks are colours (lookOfColor), which holdRule() takes for
/// white. With a tolerance of values alone, colours must be equal. Copies the units.
std::function<bool(const VoxelLook& held, const VoxelLook& look)> looksHoldRule(
    const VoxelUnits& units, const Tolerance& tolerance);

/// The largest difference from the exact picture, without rounding of floats; or kUnknownError.
struct ErrorBound {
    double color = 0;  ///< per colour channel, premultiplied
    double alpha = 0;
};

/// The bound where nothing is proved.
inline constexpr ErrorBound kUnknownError = {std::numeric_limits<double>::infinity(),
                                             std::numeric_limits<double>::infinity()};

/// Which lengths of steps through a slice colours are used for.
enum class Steps {
    kAsClassified,  ///< the length that they are classified for
    kLonger,        ///< that length or a longer one, per pixel
    kOneShorter     ///< as kLonger, but of one slice in front any share of the step may be seen
};

/// Returns the bound that docs/method.md proves for a layer on the base plane. Alpha: t. Colour, as
/// a multiple of the brightest: t if all colours are equal, else 2 t, or t + 2 t / (1 - t) with
/// longer steps. A shorter step adds to it; opaque voxels then have no bound.
/// @param brightest  of voxels' own colours, in any channel; empty: the classes' brightest
ErrorBound errorBound(const ClassTable& classes, const Tolerance& tolerance, Steps steps,
                      std::optional<double> brightest = {});

}  // namespace deltasplat
