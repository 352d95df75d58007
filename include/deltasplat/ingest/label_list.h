// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace deltasplat {

/// What a file says of a label: a value of voxels that is the number of a name.
struct LabelEntry {
    std::int64_t value = 0;
    std::string name;               ///< empty where it has none
    std::optional<glm::dvec3> rgb;  ///< sRGB, 0..1
    bool operator==(const LabelEntry&) const = default;
};

/// The labels that a file names, in its order; of values that it says to be labels and does not
/// name there may be none.
struct LabelList {
    std::vector<LabelEntry> entries;
    bool operator==(const LabelList&) const = default;
};

}  // namespace deltasplat
