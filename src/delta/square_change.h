// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "delta/class_reader.h"
#include "delta/code_blocks.h"

namespace deltasplat {

/// How voxels become one: first so many slices, along lines of sight, then what these are beside
/// each other.
struct JoinedSquares {
    glm::dvec2 shiftPerSlice;  ///< as Factorization::shiftPerSlice
    bool lastInFront;          ///< whether slices lie in front of those before them
    int slices;
    int within;  ///< as Subdivision::joinedWithin
};

/// What becomes of light and opacity where voxels beside each other become one, of the channel of
/// RGBA that changes most.
struct SquareChange {
    /// By how much more of it there is on average, as a share of the largest channel; below 0:
    /// less.
    double gained = 0;
    /// The root of the mean square of what it gains or loses from place to place, likewise of the
    /// largest channel that any place has.
    double rms = 0;
};

/// Finds out by some hundred patches of 2x2 squares through what is seen, from all over the volume:
/// what their lines of sight see. Little changes but by what goes on along lines of sight for
/// several times `slices`, and is narrower than `within`, or ends between two of them: walls seen
/// edge-on gain, and what is seen nearly so, where it is behind itself but beside it in the next
/// slices, loses. Of squares that move against lines of sight from slices to slices, by less than
/// one, no account is taken. Deterministic; multi-threaded.
/// @param blocks  ordered by u, v and slice
/// @param lights  of each class, over a slice: premultiplied RGBA
/// @return empty: nothing is seen, or slices are too many for it to be worth while
std::optional<SquareChange> squareChange(const std::vector<CodeBlock>& blocks,
                                         const ClassReader& classes,
                                         std::span<const glm::dvec4> lights,
                                         const JoinedSquares& squares);

}  // namespace deltasplat
