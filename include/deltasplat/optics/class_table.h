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

/// What a voxel looks like, whatever the length of a step through it.
struct Look {
    double extinction = 0;  ///< over one unit distance, infinite if opaque, not yet scaled
    glm::dvec3 color{0.0};  ///< scene-linear, not multiplied by opacity

    bool operator==(const Look&) const = default;
};

/// Of two slices, which is behind the other.
enum class SeenThrough { kFirst, kSecond };

/// Classified colours: premultiplied RGBA in integers. Codes that look alike share a class, so that
/// they make no deltas; class 0 is what cannot be seen.
///
/// A channel is `high + low / 2^15` units of a plane, high and low digits being integers of
/// 0..kMax. Where one digit on the first plane states alpha, colour and colour / alpha to 2^-8, low
/// is 0, as it is for almost everything. What is less than 2^-20 of the channel's largest is on a
/// second plane, whose units are 2^20 times as fine. So all that is at least 2^-40 of the largest
/// is right to 2^-8.
struct ClassTable {
    using Color = std::array<std::int16_t, 4>;
    static constexpr int kMax = 32767;  ///< the largest digit of each channel that is not all zero
    static constexpr int kDigitBits = 15;
    static constexpr int kPlaneBits = 20;
    static constexpr int kMaxPlanes = 2;
    /// Classes are numbered with 16 bits. Where all 65536 codes look different, the last two share
    /// a class.
    static constexpr int kMaxClasses = 65536;
    /// Of a medium of several parts, the class of voxels that are clear but for other parts.
    static constexpr Slot kClearClass = 1;

    /// A digit of each channel of every class.
    struct Digit {
        std::vector<Color> colors;  ///< [classes]; entry 0 is zero
        /// All classes whose digits are not zero are in [first, last).
        int first = 1;
        int last = 1;
    };
    struct Plane {
        Digit high{{Color{}}};
        Digit low;  ///< without colours if all are zero
    };
    /// One or two, the coarser first.
    std::vector<Plane> planes = std::vector<Plane>(1);
    /// What `classOfSlot` returns, shared by tables for steps of other lengths; null: of no codes.
    std::shared_ptr<const std::vector<Slot>> slots;
    /// [classes]: what each looks like exactly. No two are alike, but where all 65536 codes are
    /// not. Of pairs, [classes of one slice].
    std::vector<Look> looks;
    /// Of pairs of slices that are drawn as one (Subdivision::joined), which is seen through the
    /// other. Colours, and `size` and `unitsOf`, are then those of pairs of classes, `first *
    /// looks.size() + second`; `slots` and `looks` stay those of one slice, of which
    /// `lightOfCode` and `alphas` are not to be asked. Empty: of voxels.
    std::optional<SeenThrough> pairs;
    double unitDistanceWorld = 1;  ///< over which `looks` have their extinction
    double extinctionScale = 1;    ///< by which their extinction is still to be multiplied
    double stepWorld = 1;          ///< that colours are those of
    /// Value of one unit of each channel on the first plane; 0 for a channel that is zero
    /// throughout.
    glm::dvec4 scale{0.0};
    /// All classes have one colour and differ in opacity alone: channels are equal wherever the
    /// scale is not 0.
    bool oneColor = false;

    /// [kSlotCount]: the class of every slot, the map that `DeltaOptions::slotMap` takes. 0 for
    /// slot 0, for codes that do not occur and for clear ones.
    std::span<const Slot> classOfSlot() const {
        return slots ? std::span<const Slot>(*slots) : std::span<const Slot>();
    }
    std::size_t size() const { return planes.front().high.colors.size(); }
    /// Whether one digit says all.
    bool oneDigit() const { return planes.size() == 1 && planes.front().low.colors.empty(); }
    /// Returns the value of one unit of each channel on a plane.
    glm::dvec4 scaleOf(int plane) const;
    /// Returns the same classes for steps of another length.
    /// @param steps  of those that they are classified for, > 0
    ClassTable atSteps(double steps) const;
    /// Returns the share of light that each class takes away in a step, `[classes]`.
    std::vector<double> alphas() const;
    /// Returns what a class looks like, in units of the first plane.
    glm::dvec4 unitsOf(Slot number) const;
    /// Returns what a code looks like.
    glm::dvec4 lightOfCode(Code code) const;
};

/// Where the colours of voxels come from; opacity is always the transfer function's. All but the
/// first are looks to find one's way by.
enum class ColorBy {
    kValue,  ///< the transfer function
    kX,      ///< world x: blue where the volume begins, red where it ends
    kY,      ///< likewise
    kZ,      ///< likewise
    kIndex   ///< voxel index: red, green and blue grow from 0 to 1 along i, j and k
};

/// Returns "value", "x", "y", "z" or "index".
std::string colorByName(ColorBy colorBy);

/// What turns data values into light.
struct Optics {
    TransferFunction transferFunction;
    ColorBy colorBy = ColorBy::kValue;
    /// Data values of 0 and 1 of a normalized transfer function, the first the smaller; empty:
    /// defaultRange.
    std::optional<glm::dvec2> range;
    std::optional<double>
        unitDistance;  ///< world units of one opacity step, > 0; empty: the smallest voxel size
    double extinctionScale = 1;  ///< >= 0; multiplies the extinction
    /// In place of the transfer function's opacity: extinction in a world unit of what has the
    /// value 1, to which it is proportional, >= 0; below 0 there is none. Not with a surface.
    std::optional<double> densityScale;
    /// Lights that what is shown reflects; empty: it shines by itself, in the transfer function's
    /// colours. Not with another colorBy than kValue.
    std::optional<Shading> shading;
    /// Light that what is shown scatters; empty: none. Not with shading, a surface, opacity by
    /// gradients, or another colorBy than kValue.
    std::optional<Scattering> scattering;
    /// Shown instead of what the transfer function shows; empty: none. Not with another colorBy
    /// than kValue.
    std::optional<Surface> surface;
    /// What the transfer function's opacity, over a unit distance, is multiplied by, as a function
    /// of how much values change: straight lines between points (data units per world unit; factor
    /// of 0..1), and the first and last factor beyond them. Empty: 1. Not with a surface.
    std::vector<glm::dvec2> gradientOpacity;
    /// What else the medium has in it: at most kMostParts. Neither these nor colour grids with
    /// shading, a surface, opacity by gradients, or another colorBy than kValue.
    std::vector<MediumPart> parts;
    std::optional<ColorGrids> colorGrids;  ///< of the volume alone; empty: the function's colours
};

/// Classifies every code that occurs in the volume: extinction per world unit sigma_t = -ln(1 -
/// opacity) / unitDistance * extinctionScale, alpha = 1 - exp(-sigma_t * sliceStepWorld). Opacity 1
/// stays 1 at any step, as long as the extinction is not scaled to 0. Deterministic;
/// multi-threaded.
/// @param sliceStepWorld  world distance between consecutive slices along the line of sight, > 0
/// @throw Error(kUsage) naming the option if unit distance, extinction or range is out of range
ClassTable classify(const Volume& volume, const Optics& optics, double sliceStepWorld);

}  // namespace deltasplat
