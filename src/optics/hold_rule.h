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

/// Returns the rule by which a voxel may go on as what it was in the slice before
/// (`PackOptions::holds`): with a relative tolerance t every classified channel of what is held is
/// within t times that of the true one, with a tolerance of values the held value is within it of
/// the true one. Empty if the tolerance is exact. Refers to `classes`.
/// @throw Error(kUsage) if a tolerance is negative or not finite, or the relative one is not below
/// 1
std::function<bool(Slot held, Slot slot)> holdRule(const Volume& volume, const ClassTable& classes,
                                                   const Tolerance& tolerance);

/// The same of voxels whose looks are colours of their own (own_colors.h), which the rule above
/// takes to be white: whether one may go on as what it was. With a relative tolerance that holds in
/// every channel, with a tolerance of values alone colours have to be the same. Copies the units.
std::function<bool(const VoxelLook& held, const VoxelLook& look)> looksHoldRule(
    const VoxelUnits& units, const Tolerance& tolerance);

/// Most that a picture under a tolerance may differ from the exact one, but for the rounding of
/// floats, or kUnknownError.
struct ErrorBound {
    double color = 0;  ///< of each colour channel, premultiplied
    double alpha = 0;
};

/// What nothing is proved of.
inline constexpr ErrorBound kUnknownError = {std::numeric_limits<double>::infinity(),
                                             std::numeric_limits<double>::infinity()};

/// Which ways through a slice colours stand for.
enum class Steps {
    kAsClassified,  ///< those that they are classified for
    kLonger,        ///< these or longer ones, each pixel its own
    kOneShorter     ///< the same, but for one slice in front, of which any share may be seen
};

/// Returns the bound that docs/method.md proves for a layer on the base plane: alpha t, colour t
/// times the brightest colour if all is of one colour, otherwise 2 t times it, or (t + 2 t / (1 -
/// t)) times it where steps are longer. One that is shorter adds to it; what is opaque has no bound
/// then.
/// @param brightest  of colours that voxels have of their own, in any channel; the classes' are 1
ErrorBound errorBound(const ClassTable& classes, const Tolerance& tolerance, Steps steps,
                      std::optional<double> brightest = {});

}  // namespace deltasplat
