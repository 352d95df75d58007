// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "deltasplat/image/image.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/render_options.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

/// Whether a mode sums along the line of sight: 0 is then the value of nothing, which is black
/// unless there is less.
bool addsUp(Mode mode);

/// Makes the values of a picture, of any mode but composite, what is to be shown as greys: of an
/// x-ray the line integrals, opaque where the line of sight meets the volume's box, else clear; of
/// a radiograph the attenuation, -ln of the share that gets through, all opaque, so that white is
/// where little does, as on a light box; of others values as they are, opaque where a voxel is met.
void readyForGreys(const RenderOptions& options, const Volume& volume, const Camera& camera,
                   Image& image);

/// Returns the 0.5th and the 99.5th percentile of a picture's values, of integrals and attenuations
/// those that are not 0; empty if there are none.
std::optional<glm::dvec2> middleValues(Mode mode, const Image& image);

/// Returns what black (x) and white (y) stand for where nobody says: `middle` or, for integrals and
/// attenuations, 0 for black where `middle` begins above 0. White lies above black.
glm::dvec2 defaultWindow(Mode mode, const std::optional<glm::dvec2>& middle);

/// Shows values as greys, for formats of 8 or 16 bits: sRGB levels in proportion to them.
void showGreys(glm::dvec2 window, Image& image);

}  // namespace deltasplat
