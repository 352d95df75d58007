// SPDX-License-Identifier: Apache-2.0
// Based on: IEC 61966-2-1:1999, the sRGB transfer function.
// Based on: ITU-R BT.709-6, 2015, item 3.2.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <string_view>

#include "base/portable_math.h"

namespace deltasplat {

inline double srgbFromLinear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * portable::pow(linear, 1 / 2.4) - 0.055;
}

inline double linearFromSrgb(double v) {
    return v <= 0.04045 ? v / 12.92 : portable::pow((v + 0.055) / 1.055, 2.4);
}

/// Weights of red, green and blue in linear brightness. Their sum is 1, so a grey keeps its value.
inline constexpr glm::dvec3 kLuminance(0.2126, 0.7152, 0.0722);

/// Lower-case names of pictures' own colour space in configurations of ACES, Blender and studios.
inline constexpr std::array<std::string_view, 10> kLinearRec709{"linear rec.709 (srgb)",
                                                                "lin_rec709_srgb",
                                                                "lin_srgb",
                                                                "lin_rec709",
                                                                "linear rec.709",
                                                                "linear_srgb",
                                                                "linear rec709",
                                                                "srgb - linear",
                                                                "utility - linear - srgb",
                                                                "utility - linear - rec.709"};

}  // namespace deltasplat
