// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace deltasplat {

/// A box of voxel indices, both corners inclusive; empty when any max < min.
struct IndexBox {
    glm::ivec3 min{0};
    glm::ivec3 max{-1};

    bool empty() const { return max.x < min.x || max.y < min.y || max.z < min.z; }
    glm::ivec3 dims() const { return empty() ? glm::ivec3(0) : max - min + 1; }
    /// Readers refuse boxes of more than 2^62 voxels.
    std::int64_t voxels() const {
        const glm::ivec3 d = dims();
        return std::int64_t{d.x} * d.y * d.z;
    }
    bool operator==(const IndexBox&) const = default;
};

}  // namespace deltasplat
