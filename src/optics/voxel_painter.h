// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <bit>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "deltasplat/view/camera.h"
#include "optics/voxel_units.h"

namespace deltasplat {

/// The look of a voxel beside its class: bits that only its painter understands, a height, and how
/// faded it is. Voxels of equal class and equal look are seen alike from everywhere.
struct OwnLook {
    std::array<std::uint16_t, 3> bits{};
    std::uint8_t height = 0;  ///< above a surface, in the painter's units; 0: far below
    /// The missing share of the class' opacity over a unit distance, in 1 / kAll.
    std::uint8_t faded = 0;

    static constexpr int kAll = 255;

    bool operator==(const OwnLook& other) const {
        return std::bit_cast<std::uint64_t>(*this) == std::bit_cast<std::uint64_t>(other);
    }
};

struct VoxelLook {
    std::uint16_t number = 0;  ///< of the class, which gives the opacity; 0: not seen
    OwnLook own;

    bool operator==(const VoxelLook&) const = default;
};

/// Where a block of 8x8x8 voxels lies. Its voxels may be subdivisions of the volume's voxels.
struct BlockPlace {
    glm::dvec3 first;  ///< index position (x, y, z) of the first voxel, in the volume's voxels
    glm::dmat3 steps;  ///< from one voxel to the next along slice, u and v, likewise
};

/// Values of a volume's codes for gradients: data values, scaled.
struct GradientScale {
    std::vector<float> ofCode;  ///< [kCodeCount], finite
    /// Value of inactive voxels; empty: they have none.
    std::optional<float> background;
    double unit = 1;          ///< data units per scaled unit
    bool withValues = false;  ///< whether painters need BlockField::values, too
};

/// The scaled values of a block's voxels and their gradients, each `[slice][u][v]`.
struct BlockField {
    /// Growth of the value from one voxel of the volume to the next along x, y and z.
    std::array<std::array<float, 512>, 3> gradients;
    std::array<float, 512> values;  ///< if withValues; NaN where there is no value
};

using WordPlace = glm::ivec3;

/// Turns looks into colours for one picture. Thread-safe.
class LookLight {
  public:
    virtual ~LookLight() = default;
    const VoxelUnits& units() const { return units_; }
    double dimmest() const { return dimmest_; }
    /// Whether details beside the brightest voxels may need more than one plane.
    bool isFine() const { return isFine_; }
    /// Returns the premultiplied colours of a word's voxels, undefined where they are invisible.
    /// @param classes  [64]
    void light(const WordPlace& place, const std::uint16_t* classes, const OwnLook* looks,
               WordUnits& colors) const {
        lightVoxels(place, classes, looks, colors);
        fade(classes, looks, colors);
    }

  protected:
    /// @param dimmest  share of the brightest light that still needs full precision
    explicit LookLight(VoxelUnits units, double dimmest = 1)
        : units_(std::move(units)), dimmest_(dimmest) {}
    /// As light(), without fading.
    virtual void lightVoxels(const WordPlace& place, const std::uint16_t* classes,
                             const OwnLook* looks, WordUnits& colors) const = 0;
    void setFine() { isFine_ = true; }

  private:
    void fade(const std::uint16_t* classes, const OwnLook* looks, WordUnits& colors) const;

    VoxelUnits units_;
    double dimmest_;
    bool isFine_ = false;
};

struct BlockSet {
    std::vector<glm::ivec3> positions;  ///< (x, y, z) / 8 of first voxels, without duplicates
    IndexBox box;                       ///< of the visible voxels
};

struct LitScene {
    const Camera& camera;
    glm::dmat4 worldFromVoxel;  ///< for voxels (slice, u, v) as in words
    /// The covariance, in such voxels, of a voxel's footprint in its slice: uu, vv and uv.
    glm::dvec3 blur;
    int sliceAxis;
};

/// Gives voxels looks that only the painter understands. Must be thread-safe and deterministic.
class VoxelPainter {
  public:
    virtual ~VoxelPainter() = default;
    /// Whether classes must distinguish colours, too, not only opacities.
    virtual bool needsColors() const = 0;
    /// Whether the painter chooses the classes. A voxel may then be seen if a neighbour is.
    virtual bool choosesClasses() const { return false; }
    /// Only if choosesClasses(): whether a voxel of a code is shown although none of its
    /// subdivisions is inside. Such a voxel has class 1 and a default OwnLook.
    virtual bool isSeenItself(Code /*code*/) const { return false; }
    /// Only if choosesClasses(): the largest OwnLook::height of voxels inside the surface.
    virtual int heightOfSurface() const { return OwnLook::kAll; }
    /// The values for gradients; null: the painter needs none.
    virtual const GradientScale* gradientScale() const { return nullptr; }
    /// Paints the visible voxels of a block; the results of other voxels are undefined.
    /// @param field    if the painter needs gradients
    /// @param classes  [slice][u][v], 0: invisible. Written if choosesClasses(); otherwise only
    ///                 cleared, or, if there is more(), changed from 0 to kClearClass.
    virtual void paint(const BlockPlace& place, const BlockField* field,
                       std::span<std::uint16_t, 512> classes,
                       std::span<OwnLook, 512> looks) const = 0;
    virtual bool dependsOnCamera() const = 0;
    /// Whether PackOptions::looksHold may apply: no camera, and the opacities of classes.
    virtual bool mayHold() const { return !dependsOnCamera(); }
    /// Whether equal looks are seen differently elsewhere. Voxels then change in each slice.
    virtual bool isEverywhereOther() const { return false; }
    virtual bool dividesVoxels() const { return !isEverywhereOther(); }
    /// Blocks that the painter may fill besides visible voxels; null: none.
    virtual const BlockSet* more() const { return nullptr; }
    /// Returns the light that turns looks into colours.
    /// @param classes  the classes of paint()
    /// @param scene    null if nothing depends on the camera
    virtual std::unique_ptr<const LookLight> lightOf(const ClassTable& classes,
                                                     const LitScene* scene) const = 0;
};

/// Returns the painter for a volume; null if the transfer function determines all looks.
std::unique_ptr<const VoxelPainter> makePainter(const Volume& volume, const Optics& optics);

/// Returns a scene-linear colour, not multiplied by opacity, as three half floats >= 0.
inline OwnLook lookOfColor(const glm::dvec3& color) {
    OwnLook look;
    for (int c = 0; c < 3; ++c)
        look.bits[std::size_t(c)] = openvdb::math::half(float(color[c])).bits();
    return look;
}

inline glm::dvec3 colorOfLook(const OwnLook& look) {
    glm::dvec3 color;
    for (int c = 0; c < 3; ++c) {
        openvdb::math::half half;
        half.setBits(look.bits[std::size_t(c)]);
        color[c] = float(half);
    }
    return color;
}

class ClassLight : public LookLight {
  public:
    explicit ClassLight(const ClassTable& classes);

  protected:
    void lightVoxels(const WordPlace& place, const std::uint16_t* classes, const OwnLook* looks,
                     WordUnits& colors) const override;

  private:
    std::vector<glm::vec4> colors_;  // [classes]: premultiplied
};

// The painters that makePainter() chooses from; their volumes are not empty.

/// Returns the painter that colours voxels by position.
/// @param colorBy  not kValue
std::unique_ptr<const VoxelPainter> makePositionPainter(const Volume& volume, ColorBy colorBy);

/// Returns the painter that stores gradients, so that voxels reflect lights.
std::unique_ptr<const VoxelPainter> makeShadingPainter(const Volume& volume,
                                                       const Shading& shading);

/// Returns the painter of a surface. Voxels show by their share inside the surface.
/// @param shading  empty: one colour from all sides
std::unique_ptr<const VoxelPainter> makeSurfacePainter(const Volume& volume, const Surface& surface,
                                                       const std::optional<Shading>& shading);

/// Returns the painter that lights fog. Sweeps the volume from each light on.
/// @param optics  with scattering
/// @throw Error(kFailed) if there is not enough memory
std::unique_ptr<const VoxelPainter> makeScatterPainter(const Volume& volume, const Optics& optics);

/// Returns the painter that fades voxels by their gradients (Optics::gradientOpacity, not empty).
/// @param inner  painter of the looks; null: voxels look like their classes
std::unique_ptr<const VoxelPainter> makeFadingPainter(const Volume& volume,
                                                      const std::vector<glm::dvec2>& factors,
                                                      std::unique_ptr<const VoxelPainter> inner);

/// Returns the painter that adds other parts and colour grids to a volume, which may be empty. Also
/// lights the medium, as makeScatterPainter() does, if asked for.
std::unique_ptr<const VoxelPainter> makeMediumPainter(const Volume& volume, const Optics& optics);

}  // namespace deltasplat
