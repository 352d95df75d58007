// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/progress.h"

namespace deltasplat {

/// Returns who is told of a part of the work, whose progress goes `from` a share `to` another.
/// @param listener  must live as long
inline Listener partOf(const Listener& listener, double from, double to) {
    return {[&listener, from, to](double share) { listener.report(from + (to - from) * share); },
            listener.warning};
}

}  // namespace deltasplat
