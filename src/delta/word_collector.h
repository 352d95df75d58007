// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "delta/packed_deltas.h"

namespace deltasplat {

/// A word before all words are in one place.
struct PendingWord {
    std::uint64_t visible;
    std::uint64_t changed;
    std::size_t classes;  ///< where they begin in the columns' storage, and looks in theirs
    int slice;
    glm::ivec2 block;
};

/// Words of columns of blocks, and the classes that they point to.
struct PackedColumns {
    std::vector<PendingWord> words;
    std::vector<ClassIndex> storage;
    std::vector<OwnLook> looks;  ///< likewise, if voxels have their own
};

/// Puts the words of columns in the order of slices, those that slabs need, and takes over their
/// storage. Multi-threaded.
/// @param columns  ordered by u, then v
/// @param layout   of the slabs that `packed` has
void collectWords(std::vector<PackedColumns*> columns, const SlabLayout& layout, bool hasLooks,
                  PackedDeltas& packed);

}  // namespace deltasplat
