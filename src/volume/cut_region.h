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

/// The voxels of a volume that a mask keeps: the nearest voxel of the mask is active and not 0.
class MaskVoxels {
  public:
    /// @param mask  must outlive this object
    MaskVoxels(const Volume& mask, const VolumeData& volume);

    /// Whether the mask's voxels lie elsewhere than the volume's.
    bool resamples() const { return !shift_; }
    /// Box of the volume's indices outside of which the mask keeps nothing.
    const IndexBox& box() const { return box_; }
    /// Switches off the voxels of a block that the mask does not keep.
    void keepIn(const openvdb::Coord& origin, CodeTree::Leaf::NodeMaskType& voxels) const;

  private:
    openvdb::Coord placeOf(const openvdb::Coord& voxel) const;

    const CodeTree::Tree& tree_;
    std::bitset<kCodeCount> keeps_;  // [code of the mask]
    glm::dmat4 maskFromVolume_{1.0};
    std::optional<openvdb::Coord> shift_;  // mask index minus volume index, if whole
    IndexBox box_;
};

/// A clip plane in index space; distances are in voxel widths along the normal, > 0 where kept.
struct IndexPlane {
    glm::dvec3 slope{0.0};
    double offset = 0;

    /// Rises with each index that has a positive slope, in floating point as well.
    double distanceAt(const glm::dvec3& posIndex) const {
        return slope.x * posIndex.x + slope.y * posIndex.y + slope.z * posIndex.z + offset;
    }
    /// Returns the kept share 0..1 of a voxel's box; exact only for a normal along a volume's axis.
    double keptShare(const glm::dvec3& posIndex) const {
        return std::clamp(0.5 + distanceAt(posIndex), 0.0, 1.0);
    }
};

/// Voxels that miss a cut only by rounding are kept.
inline constexpr double kCutRounding = 1e-6;

/// @param plane  normal is not 0
IndexPlane indexPlane(const ClipPlane& plane, const glm::dmat4& worldFromIndex);

inline constexpr IndexBox kAllIndices{glm::ivec3(std::numeric_limits<int>::min()),
                                      glm::ivec3(std::numeric_limits<int>::max())};

/// How many voxels of a set are kept. With kSome the count may still turn out to be none or all.
enum class Kept { kNone, kSome, kAll };

/// The region that a cut keeps: inside the box, beyond all planes and in the mask.
struct CutRegion {
    IndexBox box = kAllIndices;
    std::vector<IndexPlane> planes;
    const MaskVoxels* mask = nullptr;  ///< null: none

    Kept keptOf(const IndexBox& voxels) const;
    /// Switches off the voxels of a block that the region does not keep.
    void keepIn(const openvdb::Coord& origin, CodeTree::Leaf::NodeMaskType& voxels) const;
};

IndexBox sharedBox(const IndexBox& a, const IndexBox& b);

}  // namespace deltasplat
