// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "base/affine.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/class_table.h"
#include "deltasplat/optics/medium.h"
#include "optics/class_numbers.h"
#include "optics/voxel_painter.h"

namespace deltasplat {

/// Returns the unit distances of the way from one corner to the other of all that there is of a
/// medium.
inline double longestWay(const Volume& volume, const Optics& optics) {
    WorldBox world = worldBox(volume.box, volume.worldFromIndex);
    for (const MediumPart& part : optics.parts) {
        const WorldBox other = worldBox(part.volume->box, part.volume->worldFromIndex);
        world.min = glm::min(world.min, other.min);
        world.max = glm::max(world.max, other.max);
    }
    return glm::length(world.max - world.min) / unitDistanceOf(volume, optics);
}

/// Returns a volume with room for what is seen besides. What is seen where nothing else is makes it
/// one that is not empty.
Volume withRoom(const Volume& volume, const BlockSet& more);

/// Black bodies that are hotter are taken for this hot.
inline constexpr double kHottestKelvin = 1e5;

/// What a part of a medium adds to a ray on a unit distance.
struct PartLook {
    double extinction = 0;  ///< may be infinite
    glm::dvec3 color{0.0};  ///< of what swallows light, not multiplied by opacity
    glm::dvec3 glow{0.0};   ///< radiance

    bool operator==(const PartLook&) const = default;
};

/// The different looks that a part's values have.
struct PartLooks {
    std::vector<PartLook> looks;        ///< the first is that of nothing
    std::vector<std::uint16_t> ofSlot;  ///< [kSlotCount]: which look a slot has

    /// Returns the largest that any has of each member.
    PartLook largest() const;
};

/// Looks up what the values of a part look like.
/// @param levels         the part as it is read (PartSampler)
/// @param unitDistances  that the longest way through the volume has: what glows too little to be
///                       seen on it is nothing
PartLooks lookUpPart(const MediumPart& part, const Volume& levels, double unitDistances);

}  // namespace deltasplat
