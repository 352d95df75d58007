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

/// What a voxel looks like beside its class: bits that only its painter understands, and how much
/// of it there is. What has the same class and the same look is seen alike from everywhere.
struct OwnLook {
    std::array<std::uint16_t, 3> bits{};
    std::uint8_t height = 0;  ///< above a surface, as its painter counts; 0: far below
    /// The share of its class' opacity over a unit distance that it has not, of kAll.
    std::uint8_t faded = 0;

    static constexpr int kAll = 255;

    bool operator==(const OwnLook& other) const {
        return std::bit_cast<std::uint64_t>(*this) == std::bit_cast<std::uint64_t>(other);
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
    double unit = 1;          ///< data units that a number of 1 stands for
    bool withValues = false;  ///< whether the values are wanted besides
};

/// The scaled values of a block's voxels and how they change, each `[slice][u][v]`.
struct BlockField {
    /// How much the value grows from a voxel of the volume to the next along x, y and z.
    std::array<std::array<float, 512>, 3> gradients;
    std::array<float, 512> values;  ///< if they are wanted; NaN where nothing is
};

/// Where a word's voxels lie: (slice, u, v) of the first.
using WordPlace = glm::ivec3;

/// Tells what looks are seen as in one picture. Thread-safe.
class LookLight {
  public:
    virtual ~LookLight() = default;
    /// The units that colours are in.
    const VoxelUnits& units() const { return units_; }
    double dimmest() const { return dimmest_; }
    /// Whether there may be something next to what is brightest that one plane cannot tell.
    bool isFine() const { return isFine_; }
    /// Returns the premultiplied colours of a word's voxels; what those get that cannot be seen is
    /// of no consequence.
    /// @param classes  [64]
    void light(const WordPlace& place, const std::uint16_t* classes, const OwnLook* looks,
               WordUnits& colors) const {
        lightVoxels(place, classes, looks, colors);
        fade(classes, looks, colors);
    }

  protected:
    /// @param dimmest  share of the brightest that what is lit worst still has, if it is to be seen
    ///                 as it is
    explicit LookLight(VoxelUnits units, double dimmest = 1)
        : units_(std::move(units)), dimmest_(dimmest) {}
    /// As light(), of voxels that are not faded.
    virtual void lightVoxels(const WordPlace& place, const std::uint16_t* classes,
                             const OwnLook* looks, WordUnits& colors) const = 0;
    void setFine() { isFine_ = true; }

  private:
    void fade(const std::uint16_t* classes, const OwnLook* looks, WordUnits& colors) const;

    VoxelUnits units_;
    double dimmest_;
    bool isFine_ = false;
};

/// Blocks of 8x8x8 voxels.
struct BlockSet {
    std::vector<glm::ivec3> positions;  ///< (x, y, z) of first voxels divided by 8, each once
    IndexBox box;                       ///< all that is seen of them
};

/// A camera, and where the voxels lie that it sees.
struct LitScene {
    const Camera& camera;
    glm::dmat4 worldFromVoxel;  ///< of voxels as words count them: (slice, u, v)
    /// The covariance of where in its slice a voxel is seen, in such voxels: uu, vv and uv.
    glm::dvec3 blur;
    int sliceAxis;
};

/// Gives voxels looks of their own. Who packs deltas asks it, and knows nothing of what it knows.
/// Must be thread-safe, and give a voxel the same look whenever it is asked.
class VoxelPainter {
  public:
    virtual ~VoxelPainter() = default;
    /// Whether classes tell colours apart too, not opacities alone.
    virtual bool needsColors() const = 0;
    /// Whether it says of which class voxels are. A voxel may then be seen if it or one beside it
    /// is of a class that is.
    virtual bool choosesClasses() const { return false; }
    /// If it does, whether a voxel of a code is seen for itself: then it is shown, in class 1 and
    /// as any OwnLook is at first, where nothing that it is divided into is inside.
    virtual bool isSeenItself(Code /*code*/) const { return false; }
    /// If it does, the OwnLook::height up to which voxels are inside of what they are of.
    virtual int heightOfSurface() const { return OwnLook::kAll; }
    /// What gradients are to be taken of; null: it needs none.
    virtual const GradientScale* gradientScale() const { return nullptr; }
    /// Paints the voxels of a block that can be seen; what others get is of no consequence.
    /// @param field    if it needs gradients
    /// @param classes  [slice][u][v]: 0 is what cannot be seen; written if it chooses them, else
    ///                 at most cleared, or made kClearClass where they are 0 if there is more()
    virtual void paint(const BlockPlace& place, const BlockField* field,
                       std::span<std::uint16_t, 512> classes,
                       std::span<OwnLook, 512> looks) const = 0;
    /// Whether what is painted looks different from different sides.
    virtual bool dependsOnCamera() const = 0;
    /// Whether voxels may go on as what they were in the slice before (PackOptions::looksHold): not
    /// if that depends on the camera, nor if opacity is not that of classes.
    virtual bool mayHold() const { return !dependsOnCamera(); }
    /// Whether what has the same class and look is seen as something else in another place, from
    /// whichever side. Voxels then change from each slice to the next, and are not divided.
    virtual bool isEverywhereOther() const { return false; }
    /// Whether it can paint what voxels are divided into.
    virtual bool dividesVoxels() const { return !isEverywhereOther(); }
    /// What it may paint besides voxels that can be seen; null: nothing.
    virtual const BlockSet* more() const { return nullptr; }
    /// Returns what looks are seen as.
    /// @param classes  what those of paint() look like
    /// @param scene    null where nothing depends on it
    virtual std::unique_ptr<const LookLight> lightOf(const ClassTable& classes,
                                                     const LitScene* scene) const = 0;
};

/// Returns who paints the voxels of a volume: nobody, if the transfer function says all.
std::unique_ptr<const VoxelPainter> makePainter(const Volume& volume, const Optics& optics);

/// Returns the look that is a colour, scene-linear and not multiplied by opacity: three half
/// floats of at least 0, which have one notation each.
inline OwnLook lookOfColor(const glm::dvec3& color) {
    OwnLook look;
    for (int c = 0; c < 3; ++c)
        look.bits[std::size_t(c)] = openvdb::math::half(float(color[c])).bits();
    return look;
}

/// Returns the colour that lookOfColor() made a look of.
inline glm::dvec3 colorOfLook(const OwnLook& look) {
    glm::dvec3 color;
    for (int c = 0; c < 3; ++c) {
        openvdb::math::half half;
        half.setBits(look.bits[std::size_t(c)]);
        color[c] = float(half);
    }
    return color;
}

/// Voxels shine in the colours of their classes.
class ClassLight : public LookLight {
  public:
    explicit ClassLight(const ClassTable& classes);

  protected:
    void lightVoxels(const WordPlace& place, const std::uint16_t* classes, const OwnLook* looks,
                     WordUnits& colors) const override;

  private:
    std::vector<glm::vec4> colors_;  // [classes]: premultiplied
};

// The painters that makePainter (voxel_painter.h) chooses from, of volumes that are not empty.

/// Returns who colours voxels by where they are.
/// @param colorBy  not kValue
std::unique_ptr<const VoxelPainter> makePositionPainter(const Volume& volume, ColorBy colorBy);

/// Returns who knows how voxels lie, so that they reflect lights in the colours of their classes.
std::unique_ptr<const VoxelPainter> makeShadingPainter(const Volume& volume,
                                                       const Shading& shading);

/// Returns who draws a surface. Voxels are of the class that is seen by the share of them that lies
/// inside.
/// @param shading  empty: in one colour from everywhere
std::unique_ptr<const VoxelPainter> makeSurfacePainter(const Volume& volume, const Surface& surface,
                                                       const std::optional<Shading>& shading);

/// Returns who lights fog. Sweeps the volume from each light on.
/// @param optics  with scattering
/// @throw Error(kFailed) if there is not enough memory
std::unique_ptr<const VoxelPainter> makeScatterPainter(const Volume& volume, const Optics& optics);

/// Returns who makes voxels less opaque by how much values change there.
/// @param factors  Optics::gradientOpacity, not empty
/// @param inner    who paints them otherwise; null: they look as their classes do
std::unique_ptr<const VoxelPainter> makeFadingPainter(const Volume& volume,
                                                      const std::vector<glm::dvec2>& factors,
                                                      std::unique_ptr<const VoxelPainter> inner);

/// Returns who adds the other parts of a medium, and colours of grids, to a volume, which may be
/// empty, and lights it as makeScatterPainter does, if that is asked for.
std::unique_ptr<const VoxelPainter> makeMediumPainter(const Volume& volume, const Optics& optics);

}  // namespace deltasplat
