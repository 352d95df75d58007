// SPDX-License-Identifier: Apache-2.0
// Based on: IEC 61966-2-1:1999, the sRGB transfer function.
#pragma once

#include "portable_math.h"

namespace deltasplat {

inline double srgbFromLinear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * portable::pow(linear, 1 / 2.4) - 0.055;
}

inline double linearFromSrgb(double v) {
    return v <= 0.04045 ? v / 12.92 : portable::pow((v + 0.055) / 1.055, 2.4);
}

}  // namespace deltasplat
