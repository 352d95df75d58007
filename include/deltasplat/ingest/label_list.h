// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace deltasplat {

/// A label in a file: a voxel value that stands for a name.
struct LabelEntry {
    std::int64_t value = 0;
    std::string name;               ///< empty: none
    std::optional<glm::dvec3> rgb;  ///< sRGB, 0..1
    bool operator==(const LabelEntry&) const = default;
};

/// The named labels of a file, in its order; may be empty although values are labels.
struct LabelList {
    std::vector<LabelEntry> entries;
    bool operator==(const LabelList&) const = default;
};

}  // namespace deltasplat
