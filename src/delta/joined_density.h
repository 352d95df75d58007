// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "delta/class_reader.h"
#include "delta/code_blocks.h"

namespace deltasplat {

/// How voxels become one: first so many slices, along lines of sight, then what these are beside
/// each other.
struct JoinedSquares {
    glm::dvec2 shiftPerSlice;  ///< as Factorization::shiftPerSlice
    int slices;
    int within;  ///< as Subdivision::joinedWithin
};

/// What becomes of opacity, 0 to 1, where voxels beside each other become one.
struct DensityChange {
    double gained = 0;  ///< on average, as a share of all that is seen; below 0: lost
    double rms = 0;     ///< the root of the mean square of what squares gain, or lose
};

/// Finds out by some hundred lines of sight all over the volume, each with those of its square.
/// Little changes but by what goes on along lines of sight for several times `slices`, and is
/// narrower than `within`, or ends between two of them: walls seen edge-on gain, and what is seen
/// nearly so, where it is behind itself but beside it in the next slices, loses. Deterministic;
/// multi-threaded.
/// @param blocks  ordered by u, v and slice
/// @param alphas  of each class, over a slice
DensityChange densityChange(const std::vector<CodeBlock>& blocks, const ClassReader& classes,
                            std::span<const double> alphas, const JoinedSquares& squares);

}  // namespace deltasplat
