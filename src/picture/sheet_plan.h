// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "picture/prepared_axis.h"

namespace deltasplat {

/// Volumes of fewer active voxels are drawn slice by slice: a few milliseconds are all that could
/// be saved. Tests make it less.
inline std::atomic<std::uint64_t> leastVoxelsJoined{std::uint64_t{1} << 23};

/// How finely voxels are drawn: what they are divided into, or whether slices are joined, and
/// how many sheet pixels they have.
class SheetPlan {
  public:
    /// @param view         of the volume's own voxels; the first of the picture's
    /// @param keepsSlices  whether each has to be drawn by itself
    /// @throw Error for a division that is asked for and cannot be made
    SheetPlan(const PreparedScene::Impl& scene, const Camera& camera, const Factorization& view,
              bool keepsSlices, const Listener& listener);

    /// Slices that are drawn as one.
    int joined() const { return parts_.joined; }
    /// What voxels are drawn as in a view of the picture.
    Subdivision partsIn(const Factorization& view) const;
    /// Sheet pixels of what voxels are divided into.
    double resolution() const { return resolution_ / parts_.within; }
    /// How wide the footprint of one is in a view: 1 where it has a sheet pixel of its own and is
    /// seen in no other. Empty: as wide as sigma asks for.
    std::optional<int> footprintWidth(const Factorization& view) const;

  private:
    bool asksForSigma_;
    std::optional<int> footprintWidth_;  // asked for
    Subdivision parts_;
    glm::ivec3 firstVoxel_;
    double resolution_;  // of undivided voxels
};

}  // namespace deltasplat
