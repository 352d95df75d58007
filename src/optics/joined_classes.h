// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "delta/slice_joiner.h"
#include "deltasplat/optics/class_table.h"

namespace deltasplat {

/// Whether slices of voxels of these classes can be joined: all have one colour, for then it does
/// not matter which is in front, or there are few enough for pairs of them to be numbered.
bool canBeJoined(const ClassTable& classes);

/// Returns what joins slices.
/// @throw std::logic_error if they cannot be joined
SliceJoiner joinerOf(const ClassTable& classes);

/// Returns the classes that voxels of joined slices have, in steps that are so many times as long.
/// @param seenThrough  which of two is behind
ClassTable joinedClasses(const ClassTable& classes, const SliceJoiner& joiner,
                         SeenThrough seenThrough, double steps);

}  // namespace deltasplat
