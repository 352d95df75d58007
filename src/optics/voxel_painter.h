// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "deltasplat/view/camera.h"
#include "optics/voxel_units.h"

namespace deltasplat {

/// What a voxel looks like beside its class: bits that only its painter understands. What has the
/// same class and the same bits looks the same from everywhere.
struct OwnLook {
    std::array<std::uint16_t, 4> bits{};

    bool operator==(const OwnLook& other) const {
        return std::bit_cast<std::uint64_t>(bits) == std::bit_cast<std::uint64_t>(other.bits);
    }
};

/// What a voxel looks like that has a look of its own.
struct VoxelLook {
    std::uint16_t number = 0;  ///< of its class, which says how opaque it is; 0: not seen
    OwnLook own;

    bool operator==(const VoxelLook&) const = default;
};

/// Where a block of 8x8x8 voxels lies, which may be what a volume's own are divided into.
struct BlockPlace {
    glm::dvec3 first;  ///< index position (x, y, z) of its first voxel, in the volume's own voxels
    glm::dmat3 steps;  ///< from a voxel to the next along slice, u and v, likewise
};

/// Numbers that a volume's codes stand for where gradients are taken: data values, scaled.
struct GradientScale {
    std::vector<float> ofCode;  ///< [kCodeCount], finite
    /// Of what is not active; empty: nothing is there.
    std::optional<float> background;
};

/// Gradients of a block's voxels, each `[slice][u][v]`: how much the scaled value grows from a
/// voxel of the volume to the next along x, y and z.
using BlockGradients = std::array<std::array<float, 512>, 3>;

/// Where a word's voxels lie: (slice, u, v) of the first.
using WordPlace = glm::ivec3;

/// Tells what looks are seen as in one picture. Thread-safe.
class LookLight {
  public:
    virtual ~LookLight() = default;
    /// The units that colours are in.
    const VoxelUnits& units() const { return units_; }
    /// Returns the premultiplied colours of a word's voxels; what those get that cannot be seen is
    /// of no consequence.
    /// @param classes  [64]
    virtual void light(const WordPlace& place, const std::uint16_t* classes, const OwnLook* looks,
                       WordUnits& colors) const = 0;

  protected:
    explicit LookLight(VoxelUnits units) : units_(std::move(units)) {}

  private:
    VoxelUnits units_;
};

/// A camera, and where the voxels lie that it sees.
struct LitScene {
    const Camera& camera;
    glm::dmat4 worldFromVoxel;  ///< of voxels as words count them: (slice, u, v)
};

/// Gives voxels looks of their own. Who packs deltas asks it, and knows nothing of what it knows.
/// Must be thread-safe, and give a voxel the same look whenever it is asked.
class VoxelPainter {
  public:
    virtual ~VoxelPainter() = default;
    /// Whether classes tell colours apart too, not opacities alone.
    virtual bool needsColors() const = 0;
    /// What gradients are to be taken of; null: it needs none.
    virtual const GradientScale* gradientScale() const { return nullptr; }
    /// Paints the voxels of a block that can be seen; what others get is of no consequence.
    /// @param gradients  if it needs them
    /// @param classes    [slice][u][v]: 0 is what cannot be seen
    virtual void paint(const BlockPlace& place, const BlockGradients* gradients,
                       std::span<const std::uint16_t, 512> classes,
                       std::span<OwnLook, 512> looks) const = 0;
    /// Whether what is painted looks different from different sides.
    virtual bool dependsOnCamera() const = 0;
    /// Returns what looks are seen as.
    /// @param classes  what those of paint() look like
    /// @param scene    null where nothing depends on it
    virtual std::unique_ptr<const LookLight> lightOf(const ClassTable& classes,
                                                     const LitScene* scene) const = 0;
};

/// Returns who paints the voxels of a volume: nobody, if the transfer function says all.
std::unique_ptr<const VoxelPainter> makePainter(const Volume& volume, const Optics& optics);

}  // namespace deltasplat
