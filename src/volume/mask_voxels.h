// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <glm/mat4x4.hpp>
#include <optional>

#include "volume/code_tree.h"

namespace deltasplat {

/// Which voxels of a volume a mask keeps: those whose nearest voxel of the mask is active and not
/// 0.
class MaskVoxels {
  public:
    /// @param mask  must outlive this
    MaskVoxels(const Volume& mask, const Volume& volume);

    /// Whether the mask's voxels lie elsewhere than the volume's.
    bool resamples() const { return !shift_; }
    /// Box of the volume's indices outside of which nothing is kept.
    const IndexBox& box() const { return box_; }
    /// Switches off the voxels of a block that are not kept.
    void keepIn(const openvdb::Coord& origin, CodeTree::Leaf::NodeMaskType& voxels) const;

  private:
    openvdb::Coord placeOf(const openvdb::Coord& voxel) const;

    const CodeTree::Tree& tree_;
    std::bitset<kCodeCount> keeps_;  // by the mask's codes
    glm::dmat4 maskFromVolume_{1.0};
    std::optional<openvdb::Coord>
        shift_;  // the mask's index less the volume's, where that is whole
    IndexBox box_;
};

}  // namespace deltasplat
