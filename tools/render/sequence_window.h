// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <vector>

#include "render/render_options.h"
#include "sequence/frame_options.h"
#include "sequence/sequence_look.h"

namespace deltasplat {

/// Returns the values that black and white stand for in all pictures of a sequence alike: what
/// `defaultWindow` takes from one, of all of them. Each is rendered for it, as many at once as
/// there are `workers`, and not kept. What is wrong with a frame is said when it is shown.
/// @param commandOf  makes the i-th frame's command
/// @throw Error(kInterrupted)
glm::dvec2 sequenceWindow(const std::vector<FrameFiles>& frames,
                          const std::function<RenderCommand(std::size_t i)>& commandOf,
                          SequenceLook& look, int workers, const Listener& listener);

}  // namespace deltasplat
