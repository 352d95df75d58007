// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bitset>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "deltasplat/cut/cut_volume.h"
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

/// A clip plane as voxels see it: how far beyond it, on the side that is kept, a place lies, in
/// widths of a voxel's box along the normal.
struct IndexPlane {
    glm::dvec3 slope{0.0};
    double offset = 0;

    /// Rises with each index whose slope is positive, in floating point as well.
    double distanceAt(const glm::dvec3& posIndex) const {
        return slope.x * posIndex.x + slope.y * posIndex.y + slope.z * posIndex.z + offset;
    }
    /// Returns about which share 0..1 of a voxel's box lies on the side that is kept: exactly where
    /// the normal is along an axis of the volume.
    double keptShare(const glm::dvec3& posIndex) const {
        return std::clamp(0.5 + distanceAt(posIndex), 0.0, 1.0);
    }
};

/// Voxels that are off by rounding alone are kept.
inline constexpr double kCutRounding = 1e-6;

/// @param plane  of a normal other than 0
IndexPlane indexPlane(const ClipPlane& plane, const glm::dmat4& worldFromIndex);

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
