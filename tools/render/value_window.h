// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "deltasplat/image/image.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/render_options.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

/// Shows the line integrals of an x-ray as greys, for formats of 8 or 16 bits: sRGB levels in
/// proportion to values, opaque where the line of sight meets the volume's box, else clear.
/// @param window  what black (x) and white (y) stand for; empty: the 0.5th and the 99.5th
/// percentile
///                of the integrals that are not 0, or 0 for black where that is above 0
/// @return        the window
glm::dvec2 greyXray(const Volume& volume, const Camera& camera,
                    const std::optional<glm::dvec2>& window, Image& image);

/// Shows a radiograph as light boxes do, white where little gets through: greys of the attenuation,
/// -ln of the share that gets through, all opaque. The window is as of `greyXray`.
glm::dvec2 greyRadiograph(const Drr& drr, const std::optional<glm::dvec2>& window, Image& image);

/// The same of values that are met, which are opaque where a voxel is met. By default the window
/// goes from the 0.5th to the 99.5th percentile of the pixels' values.
glm::dvec2 greyMip(const std::optional<glm::dvec2>& window, Image& image);

}  // namespace deltasplat
