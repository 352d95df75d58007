// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/render.h"

namespace deltasplat {

/// Renders what lines of sight from an eye meet of a volume that is not empty, pixel by pixel:
/// all modes but kComposite; of kDrr the integrals. As `renderRays` otherwise.
void renderFromEye(const Volume& volume, const RenderOptions& options, const Listener& listener,
                   RenderResult& result);

}  // namespace deltasplat
