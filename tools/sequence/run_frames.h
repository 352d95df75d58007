// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "deltasplat/progress.h"
#include "listener.h"
#include "sequence/frame_options.h"

namespace deltasplat {

/// Calls work(i, listener) for 0 <= i < frames.size(), for several at once on threads of their own,
/// each with its share of the threads that there are; for fewer where no more can be begun. What is
/// warned of several frames in the same words, numbers aside, is shown once, and counted at the
/// end. If one fails, no more are begun, unless `keepGoing`; those begun end. Each failure is shown
/// at once.
/// @param workers  how many at once, at least 1
/// @throw Error with the code of the first frame that failed, in their order; Error(kInterrupted)
void runFrames(const std::vector<FrameFiles>& frames, bool keepGoing, int workers,
               const std::function<void(std::size_t i, const Listener&)>& work,
               const Listener& listener);

}  // namespace deltasplat
