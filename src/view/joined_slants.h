// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <span>

#include "deltasplat/view/factorization.h"

namespace deltasplat {

/// What becomes one.
struct JoinedVoxels {
    int slices = 1;
    int within = 1;  ///< as Subdivision::joinedWithin
};

/// How slices are moved that become one, and by how much that moves them.
struct JoinedSlants {
    std::array<glm::ivec2, kMostJoined> slants{};  ///< as Subdivision has them
    /// How far what is joined lies from where it is drawn, in voxels: at most.
    double farthest = 0;
    /// Whether what is thin, and seen nearly edge-on, stays as dense as it is: along u and along v,
    /// lines of sight go on by what becomes one within these slices, or hardly at all.
    bool keepsDensity = true;
};

/// Returns the slants by which slices stay nearest to their places.
/// @param shiftPerSlice  -1 to 1 each
/// @param count          a power of two, kMostJoined at most
/// @param within         as Subdivision::joinedWithin
JoinedSlants joinedSlants(const glm::dvec2& shiftPerSlice, int count, int within = 1);

/// Returns where joined voxels are drawn, counted from the first of them: in the middle between the
/// outermost places of all.
/// @param slants  as Subdivision::joinedSlants
glm::dvec2 middleOfJoined(const glm::dvec2& shiftPerSlice, std::span<const glm::ivec2> slants);

}  // namespace deltasplat
