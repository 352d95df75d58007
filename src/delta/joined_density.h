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

/// Returns by how much opacity grows where voxels beside each other become one, as a share of all
/// opacity that is seen: the mean of a few hundred lines of sight all over the volume, each with
/// those beside it. Nothing grows but what goes on along lines of sight for several times `slices`,
/// and is narrower than `within`, or ends between two of them. Deterministic; multi-threaded.
/// @param blocks  ordered by u, v and slice
/// @param alphas  of each class, over a slice
double densityGained(const std::vector<CodeBlock>& blocks, const ClassReader& classes,
                     std::span<const double> alphas, const JoinedSquares& squares);

}  // namespace deltasplat
