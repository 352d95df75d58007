// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "annotate/legend.h"
#include "render/render_options.h"

namespace deltasplat {

/// Returns what the colours of a picture stand for: the values that the transfer function's points
/// span, those of a window, or the labels that are seen in the volume.
/// @param optics  that the picture was made with
/// @param window  values of black and white, where values are shown as greys
Legend pictureLegend(const RenderCommand& command, const Volume& volume, const Optics& optics,
                     const std::optional<glm::dvec2>& window);

}  // namespace deltasplat
