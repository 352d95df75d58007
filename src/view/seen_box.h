// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "deltasplat/image/pixel_box.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

/// How a picture shows a box of voxels.
struct SeenBox {
    PixelBox part;         ///< pixels that may show something of it
    glm::dvec2 size{0.0};  ///< of the box in the picture, in pixels; infinite if the eye is near
};

/// Returns what a picture may show of a box whose voxels reach `reach` voxels beyond it.
SeenBox seenBox(const IndexBox& box, const glm::dmat4& worldFromIndex, const Camera& camera,
                double reach);

}  // namespace deltasplat
