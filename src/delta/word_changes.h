// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "delta/packed_deltas.h"

namespace deltasplat {

/// Where the words of a slab show something else in two pictures. Rows of blocks lie along u, as
/// words count them.
struct SlabChanges {
    glm::ivec2 differingRows{0};  ///< [x, y), outside of which all is the same; none if y <= x
    glm::ivec2 shownRows{0};      ///< [x, y), outside of which there is nothing; none if y <= x
    std::uint64_t differing = 0;  ///< how many rows show something else
    std::uint64_t shown = 0;      ///< how many have anything in either
};

/// Whether both have the same slices, cut into the same slabs.
bool haveSameSlabs(const PackedDeltas& before, const PackedDeltas& now);

/// Compares words of the same slabs. Ends early in rows that differ: where all does, that costs
/// next to nothing. Multi-threaded.
/// @param nowOfBefore  [classes]: what a class of `before` is among those of `now`; 0: none
/// @return [slabs]
std::vector<SlabChanges> compareWords(const PackedDeltas& before, const PackedDeltas& now,
                                      std::span<const ClassIndex> nowOfBefore);

}  // namespace deltasplat
