// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "deltasplat/ingest/slot.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/medium.h"
#include "deltasplat/optics/scattering.h"
#include "deltasplat/optics/shading.h"
#include "deltasplat/optics/surface.h"
#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// A voxel's look, whatever the length of a step through it.
struct Look {
    double extinction = 0;  ///< over one unit distance, infinite if opaque, not yet scaled
    glm::dvec3 color{0.0};  ///< scene-linear, not multiplied by opacity

    bool operator==(const Look&) const = default;
};

/// Which of two slices is behind the other.
enum class SeenThrough { kFirst, kSecond };

/// Classified colours: premultiplied RGBA in integers. Codes that look alike share a class, so that
/// they make no deltas; class 0 is invisible.
///
/// A channel is `high + low / 2^15` units of a plane; both digits are integers of 0..kMax. Low is 0
/// where one digit on the first plane gives alpha, colour and colour / alpha to 2^-8, as it does
/// almost everywhere. Channels below 2^-20 of the largest are on a second plane with units 2^20
/// times as fine. So every channel of at least 2^-40 of the largest is right to 2^-8.
struct ClassTable {
    using Color = std::array<std::int16_t, 4>;
    static constexpr int kMax = 32767;  ///< the largest digit of each channel that is not all zero
    static constexpr int kDigitBits = 15;
    static constexpr int kPlaneBits = 20;
    static constexpr int kMaxPlanes = 2;
    /// Classes have 16-bit numbers. If all 65536 codes look different, the last two share a class.
    static constexpr int kMaxClasses = 65536;
    /// Of a medium of several parts: voxels that are clear but for other parts.
    static constexpr Slot kClearClass = 1;

    /// A digit of each channel of every class.
    struct Digit {
        std::vector<Color> colors;  ///< [classes]; entry 0 is zero
        /// Classes with digits other than zero are in [first, last).
        int first = 1;
        int last = 1;
    };
    struct Plane {
        Digit high{{Color{}}};
        Digit low;  ///< without colours if all are zero
    };
    /// One or two, the coarser first.
    std::vector<Plane> planes = std::vector<Plane>(1);
    /// As `classOfSlot` returns them, shared by tables for other step lengths; null: no codes.
    std::shared_ptr<const std::vector<Slot>> slots;
    /// [classes, of one slice]: exact looks, all different unless all 65536 codes look different.
    std::vector<Look> looks;
    /// Set if colours, `size` and `unitsOf` are those of pairs of classes, `first * looks.size() +
    /// second`, as two slices are drawn as one (Subdivision::joined): the slice seen through the
    /// other. `slots` and `looks` stay those of one slice; do not call `lightOfCode` and `alphas`.
    std::optional<SeenThrough> pairs;
    double unitDistanceWorld = 1;  ///< over which `looks` have their extinction
    double extinctionScale = 1;    ///< still to be applied to the extinction of `looks`
    double stepWorld = 1;          ///< step length that colours are for
    /// Value of one unit of each channel on the first plane; 0: the channel is zero throughout.
    glm::dvec4 scale{0.0};
    /// All classes have one colour and differ in opacity only: channels with a scale are equal.
    bool oneColor = false;

    /// [kSlotCount]: the class of every slot, for `DeltaOptions::slotMap`. 0 for slot 0, for codes
    /// that do not occur and for clear codes.
    std::span<const Slot> classOfSlot() const {
        return slots ? std::span<const Slot>(*slots) : std::span<const Slot>();
    }
    std::size_t size() const { return planes.front().high.colors.size(); }
    bool oneDigit() const { return planes.size() == 1 && planes.front().low.colors.empty(); }
    /// Returns the value of one unit of each channel on a plane.
    glm::dvec4 scaleOf(int plane) const;
    /// Returns the same classes for steps that are `steps` > 0 times as long.
    ClassTable atSteps(double steps) const;
    /// Returns the share of light that each class absorbs in a step, `[classes]`.
    std::vector<double> alphas() const;
    /// Returns a class's light, in units of the first plane.
    glm::dvec4 unitsOf(Slot number) const;
    glm::dvec4 lightOfCode(Code code) const;
};

/// Source of voxel colours; opacity is the transfer function's. kX to kIndex are for orientation.
enum class ColorBy {
    kValue,  ///< the transfer function
    kX,      ///< world x (kY, kZ: y, z): blue where the volume begins, red where it ends
    kY,
    kZ,
    kIndex  ///< voxel index: red, green and blue grow from 0 to 1 along i, j and k
};

/// Returns "value", "x", "y", "z" or "index".
std::string colorByName(ColorBy colorBy);

struct Optics {
    TransferFunction transferFunction;
    ColorBy colorBy = ColorBy::kValue;
    /// Data values of 0 and 1 of a normalized transfer function, ascending; empty: defaultRange.
    std::optional<glm::dvec2> range;
    std::optional<double>
        unitDistance;  ///< world units of one opacity step, > 0; empty: smallest voxel size
    double extinctionScale = 1;  ///< >= 0; multiplies the extinction
    /// Replaces the transfer function's opacity: extinction per world unit of the value 1, >= 0. It
    /// is proportional to the value, and 0 for negative values. Not with a surface.
    std::optional<double> densityScale;
    /// Lights that the volume reflects; empty: it shines by itself, in the transfer function's
    /// colours. Not with another colorBy than kValue.
    std::optional<Shading> shading;
    /// Light that the volume scatters; empty: none. Not with shading, a surface, opacity by
    /// gradients, or another colorBy than kValue.
    std::optional<Scattering> scattering;
    /// Shown instead of the transfer function; empty: none. Not with another colorBy than kValue.
    std::optional<Surface> surface;
    /// Factor of the function's opacity over a unit distance, by the gradient: linear between
    /// points (data units per world unit; 0..1), then constant. Empty: 1. Not with a surface.
    std::vector<glm::dvec2> gradientOpacity;
    /// Further parts of the medium, at most kMostParts. Neither parts nor colour grids go with
    /// shading, a surface, opacity by gradients, or another colorBy than kValue.
    std::vector<MediumPart> parts;
    std::optional<ColorGrids> colorGrids;  ///< of the volume only; empty: the function's colours
};

/// Classifies every code that occurs in the volume: extinction per world unit sigma_t = -ln(1 -
/// opacity) / unitDistance * extinctionScale, alpha = 1 - exp(-sigma_t * sliceStepWorld). Opacity 1
/// stays 1 at any step, unless the extinction is scaled to 0. Deterministic; multi-threaded.
/// @param sliceStepWorld  world distance between consecutive slices along the line of sight, > 0
/// @throw Error(kUsage) naming the option if unit distance, extinction or range is out of range
ClassTable classify(const Volume& volume, const Optics& optics, double sliceStepWorld);

}  // namespace deltasplat
