// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/render.h"

namespace deltasplat {

/// Renders emission and absorption by splatting and compositing: what Mode::kComposite is. Fills in
/// the picture, which has its size already and is transparent, and the stages' part of the stats.
/// @throw as `render`
void renderComposite(const Volume& volume, const RenderOptions& options, const Listener& listener,
                     RenderResult& result);

}  // namespace deltasplat
