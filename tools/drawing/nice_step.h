// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace deltasplat {

/// Returns the largest of 1, 2 and 5 times a power of ten that divides `span` > 0 at least `parts`
/// times.
inline double niceStep(double span, int parts) {
    const double power = std::pow(10.0, std::floor(std::log10(span / parts)));
    for (const double factor : {5.0, 2.0}) {
        if (span / (factor * power) >= parts) return factor * power;
    }
    return power;
}

}  // namespace deltasplat
