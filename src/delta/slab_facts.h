// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "delta/slab_plan.h"

namespace deltasplat {

/// What a part of a picture has to know of a volume of which it has read some slices only.
struct SlabFacts {
    /// A slab of which something is seen.
    struct Seen {
        double work = 0;       ///< about how long it takes
        glm::ivec2 blocks{0};  ///< of 8 slices of the volume, first and last, that it is made of
    };

    std::string file;                ///< that they were read from, for messages
    std::size_t blocksSeen = 0;      ///< as PreparedScene::Impl::blocksSeen of the slice axis
    int joined = 1;                  ///< slices that are drawn as one
    int blocksPerSlab = 1;           ///< as SlabLayout::blocksPerSlab
    std::vector<PlannedSlab> slabs;  ///< in increasing order
    std::vector<Seen> seen;          ///< from the front on
    std::uint64_t words = 0;         ///< digestOfWords of the picture's only view
    std::string content;             ///< as PartHeader::content

    /// The slab that the parts up to one of so many end before: slabs are cut where their work
    /// passes it.
    int endOf(int share, int count) const;
};

}  // namespace deltasplat
