// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace deltasplat {

/// Returns "1 sheet pixel", "2 sheet pixels", "1/2 sheet pixel".
inline std::string sheetPixelsText(double resolution) {
    if (resolution < 1) return "1/" + std::to_string(int(1 / resolution)) + " sheet pixel";
    return std::to_string(int(resolution)) + (resolution == 1 ? " sheet pixel" : " sheet pixels");
}

/// Returns a whole number as one: 1, 2, or 0.5.
inline nlohmann::ordered_json resolutionJson(double resolution) {
    if (resolution < 1) return resolution;
    return int(resolution);
}

}  // namespace deltasplat
