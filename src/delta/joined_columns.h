// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "delta/code_blocks.h"

namespace deltasplat {

/// What a column of blocks is made of whose slices are joined two and two: the first ones of the
/// same column, the second ones, moved by a slant, of this and of up to three beside it.
struct JoinedColumn {
    glm::ivec2 place;  ///< (u, v) of its blocks
    /// Its own blocks, those before it by the slant along u, along v, and along both: none where
    /// the slant has no such part.
    std::array<std::span<const CodeBlock>, 4> sources;

    /// The most blocks of joined slices that there can be, of those at [firstPlace, lastPlace].
    std::size_t mostBlocks(int firstPlace, int lastPlace) const;
};

/// Lists what blocks become, ordered by u, then v.
/// @param blocks  ordered by u, v and slice; must outlive the columns
/// @param slant   as Subdivision::slant
std::vector<JoinedColumn> joinColumns(const std::vector<CodeBlock>& blocks,
                                      const glm::ivec2& slant);

}  // namespace deltasplat
