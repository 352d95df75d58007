// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace deltasplat {

/// Names of a picture's own colours, lower case, as configurations of ACES, Blender and studios
/// call them.
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
