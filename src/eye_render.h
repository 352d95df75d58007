// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ray_picture.h"

namespace deltasplat {

/// Renders what lines of sight from an eye meet, pixel by pixel: all modes but kComposite; of kDrr
/// the integrals. As `renderRays` otherwise.
/// @param image  of the task's part
void renderFromEye(const RayTask& task, const Listener& listener, Image& image, RenderStats& stats);

}  // namespace deltasplat
