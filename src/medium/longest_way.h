// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/class_table.h"
#include "optics/unit_distance.h"
#include "view/affine.h"

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

}  // namespace deltasplat
