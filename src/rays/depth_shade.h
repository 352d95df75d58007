// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace deltasplat {

/// How much of its light a place keeps by its depth: all of it at the nearest place, and `darker`
/// less at the farthest.
struct DepthShade {
    double darker = 0;  ///< 0..1
    double nearest = 0;
    double farthest = 0;

    float at(double depth) const {
        if (!(farthest > nearest)) return 1;
        const double way = (depth - nearest) / (farthest - nearest);
        return float(1 - darker * std::clamp(way, 0.0, 1.0));
    }
};

}  // namespace deltasplat
