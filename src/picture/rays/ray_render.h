// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/render.h"

namespace deltasplat {

/// Renders all modes but kComposite. Fills in the picture, which has its size and is transparent,
/// and its part of the stats. @throw as `render`
void renderRays(const Volume& volume, const RenderOptions& options, const Listener& listener,
                RenderResult& result);

}  // namespace deltasplat
