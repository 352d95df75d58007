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

/// A plane in the world: what lies on the side that its normal points to is kept, as clipping
/// planes of VTK do.
struct ClipPlane {
    glm::dvec3 pointWorld{0.0};
    glm::dvec3 normalWorld{1, 0, 0};  ///< of any length but 0
};

/// Which voxels of a volume are left: those that all of these keep. A voxel is where its centre is;
/// one that is off by no more than a millionth of a voxel is kept as well.
struct Cut {
    std::optional<IndexBox> cropIndex;  ///< not empty; may reach beyond the volume
    /// First and last index that is kept along i, j and k.
    std::array<std::optional<glm::ivec2>, 3> slices;
    std::optional<WorldBox> cropWorld;  ///< may be infinite
    std::vector<ClipPlane> clipPlanes;
    /// Keeps a voxel where the mask's nearest voxel in the world is active and not 0.
    std::shared_ptr<const Volume> mask;

    bool crops() const { return cropIndex || cropWorld || slices[0] || slices[1] || slices[2]; }
    bool empty() const { return !crops() && clipPlanes.empty() && !mask; }
};

/// Returns what is left of a volume: voxels that are cut off are not active, in a dense volume as
/// well, and count nowhere. Volume::box is what crops leave of the box (of a volume with a
/// background, or by a box in the world: the box of the active voxels that they leave), which
/// planes and masks do not change, so that a camera stays where it is. Volume::uncut has the codes
/// before. The bulk of the values (bulkRange, and by it defaultRamp, fitPreset and shading) stays
/// that of the whole volume; ask the volume before for defaultRange, wholeRamp and isHounsfield,
/// and colours do not change by cutting. Where codes are not exact and the source is not kept, the
/// new smallest and largest values are those of codes. A volume without active voxels is returned
/// as it is. Warns of a mask whose voxels are not the volume's. Multi-threaded, deterministic.
/// @throw Error(kUsage) if a box or a plane cannot be meant; Error(kUsage) or, of a mask,
///        Error(kInput) if nothing is left; Error(kFailed) if the rest does not fit into memory
Volume cutVolume(const Volume& volume, const Cut& cut, const Listener& listener = {});

}  // namespace deltasplat
