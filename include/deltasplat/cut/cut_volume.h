// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"
#include "deltasplat/view/world_box.h"

namespace deltasplat {

/// A plane in the world; keeps the side that its normal points to, like clipping planes of VTK.
struct ClipPlane {
    glm::dvec3 pointWorld{0.0};
    glm::dvec3 normalWorld{1, 0, 0};  ///< of any length but 0
};

/// Voxels of a volume to keep: those that every member keeps. A voxel's place is its centre, with a
/// tolerance of a millionth of a voxel.
struct Cut {
    std::optional<IndexBox> cropIndex;  ///< not empty; may reach beyond the volume
    /// First and last kept index along i, j and k.
    std::array<std::optional<glm::ivec2>, 3> slices;
    std::optional<WorldBox> cropWorld;  ///< may be infinite
    std::vector<ClipPlane> clipPlanes;
    /// Keeps voxels whose nearest mask voxel in the world is active and not 0.
    std::shared_ptr<const Volume> mask;

    bool crops() const { return cropIndex || cropWorld || slices[0] || slices[1] || slices[2]; }
    bool empty() const { return !crops() && clipPlanes.empty() && !mask; }
};

/// Returns the rest of a volume after a cut: removed voxels are inactive, in a dense volume too,
/// and count nowhere. Volume::box is the cropped box; with a background, or for a crop in the
/// world, it is the box of the active voxels that crops leave. Planes and masks do not change it,
/// so that a camera stays where it is. Volume::uncut has the codes before. The bulk of the values
/// (bulkRange, and by it defaultRamp, fitPreset and shading) stays the whole volume's; ask the
/// whole volume for defaultRange, wholeRamp and isHounsfield to keep colours. With inexact codes
/// and no source, the new extreme values are those of codes. Volumes without active voxels are
/// returned unchanged. Warns of a mask on other voxels. Multi-threaded, deterministic.
/// @throw Error(kUsage) for an impossible box or plane; Error(kUsage) or, for a mask, Error(kInput)
///        if nothing is left; Error(kFailed) if the rest does not fit into memory
Volume cutVolume(const Volume& volume, const Cut& cut, const Listener& listener = {});

}  // namespace deltasplat
