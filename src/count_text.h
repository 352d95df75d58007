// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace deltasplat {

/// Returns a count with words for one and for several: "1 voxel is", "2 voxels are".
inline std::string countText(std::uint64_t count, const std::string& one,
                             const std::string& several) {
    return std::to_string(count) + " " + (count == 1 ? one : several);
}

/// Likewise with a word of which several have an s more: "1 page", "2 pages".
inline std::string countText(std::uint64_t count, const std::string& one) {
    return countText(count, one, one + "s");
}

}  // namespace deltasplat
