// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include "deltasplat/threads.h"

namespace deltasplat {

/// Makes OpenEXR use as many threads as the library where OpenImageIO reads with it, which would
/// start as many as there are cores. For who writes with it there is ExrThreads
/// (src/image/exr_header.h).
/// @param mayThread  whether there may be several at all: each has memory of its own
inline void limitExrThreads(bool mayThread) {
    constexpr int kNone = -1;  // but the caller
    OIIO::attribute("exr_threads", mayThread && threadCount() > 1 ? threadCount() : kNone);
}

}  // namespace deltasplat
