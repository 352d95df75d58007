// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "cut/index_plane.h"
#include "cut/mask_voxels.h"

namespace deltasplat {

/// A box that all indices lie in.
inline constexpr IndexBox kAllIndices{glm::ivec3(std::numeric_limits<int>::min()),
                                      glm::ivec3(std::numeric_limits<int>::max())};

/// How many of some voxels are kept; kSome may turn out to be any number of them.
enum class Kept { kNone, kSome, kAll };

/// Voxels that are kept: those in the box, beyond all planes and in the mask.
struct CutRegion {
    IndexBox box = kAllIndices;
    std::vector<IndexPlane> planes;
    const MaskVoxels* mask = nullptr;  ///< null: none

    Kept keptOf(const IndexBox& voxels) const;
    /// Switches off the voxels of a block that are not kept.
    void keepIn(const openvdb::Coord& origin, CodeTree::Leaf::NodeMaskType& voxels) const;
};

/// Returns the voxels that two boxes share.
IndexBox sharedBox(const IndexBox& a, const IndexBox& b);

}  // namespace deltasplat
