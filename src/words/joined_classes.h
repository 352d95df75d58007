// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec4.hpp>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "words/slice_joiner.h"

namespace deltasplat {

/// Whether two slices of voxels of these classes can be joined for steps of any length: all have
/// one colour, for then it does not matter which is in front, or there are few enough for pairs of
/// them to be numbered.
bool canBePaired(const ClassTable& classes);

/// What becomes one.
struct JoinedRun {
    int slices;
    int within;               ///< as Subdivision::joinedWithin
    SeenThrough seenThrough;  ///< of two that follow each other, which is behind
    double steps;             ///< how many times as long as those of the classes steps are
};

/// Returns what each class looks like over a step, premultiplied; black where all have one colour.
std::vector<glm::dvec4> lightsOf(const ClassTable& classes);

/// Returns what joins slices: for steps of any length if they are of one colour, or two that can be
/// paired, and no more than slices is joined.
SliceJoiner joinerOf(const ClassTable& classes, const JoinedRun& run);

/// Returns the classes that voxels of joined slices have, once these are joined.
ClassTable joinedClasses(const ClassTable& classes, const SliceJoiner& joiner,
                         const JoinedRun& run);

}  // namespace deltasplat
