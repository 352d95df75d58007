// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <bit>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "deltasplat/optics/class_table.h"

namespace deltasplat {

/// A colour that a voxel has of its own, scene-linear, not multiplied by opacity: three half floats
/// of at least 0.
struct VoxelColor {
    std::array<std::uint16_t, 4> bits{};  ///< red, green, blue and 0

    static VoxelColor of(const glm::dvec3& color) {
        VoxelColor voxel;
        for (int c = 0; c < 3; ++c)
            voxel.bits[std::size_t(c)] = openvdb::math::half(float(color[c])).bits();
        return voxel;
    }
    glm::dvec3 color() const {
        glm::dvec3 color;
        for (int c = 0; c < 3; ++c) {
            openvdb::math::half half;
            half.setBits(bits[std::size_t(c)]);
            color[c] = float(half);
        }
        return color;
    }
    // Numbers of at least 0 have one notation each.
    bool operator==(const VoxelColor& other) const {
        return std::bit_cast<std::uint64_t>(bits) == std::bit_cast<std::uint64_t>(other.bits);
    }
};

/// What a voxel looks like that has a colour of its own.
struct VoxelLook {
    std::uint16_t number = 0;  ///< of its class, which says how opaque it is; 0: not seen
    VoxelColor color;

    bool operator==(const VoxelLook&) const = default;
};

/// Where a block of 8x8x8 voxels lies, which may be what a volume's own are divided into.
struct BlockPlace {
    glm::dvec3 first;  ///< index position (x, y, z) of its first voxel, in the volume's own voxels
    glm::dmat3 steps;  ///< from a voxel to the next along slice, u and v, likewise
};

/// Gives voxels colours of their own. Who packs deltas asks it, and knows nothing of what it
/// knows. Must be thread-safe, and give a voxel the same colour whenever it is asked.
class VoxelPainter {
  public:
    virtual ~VoxelPainter() = default;
    /// No channel of any colour is larger; each is finite and at least 0.
    virtual glm::dvec3 brightest() const = 0;
    /// Colours the voxels of a block that can be seen; what others get is of no consequence.
    /// @param classes  [slice][u][v]: 0 is what cannot be seen
    virtual void paint(const BlockPlace& place, std::span<const std::uint16_t, 512> classes,
                       std::span<VoxelColor, 512> colors) const = 0;
};

/// Returns who colours voxels of a volume: nobody, if the transfer function does.
std::unique_ptr<const VoxelPainter> makePainter(const Volume& volume, ColorBy colorBy);

}  // namespace deltasplat
