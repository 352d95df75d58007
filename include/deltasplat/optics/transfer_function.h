// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"

namespace deltasplat {

/// In which space colours between two points of a transfer function are mixed, as VTK has them.
enum class ColorSpace {
    kRgb,          ///< as they are given
    kHsv,          ///< by hue, through all hues between the two, by saturation and value
    kHsvShortest,  ///< likewise, by the shorter way around the circle of hues
    kLab,          ///< CIE L*a*b*
    kDiverging  ///< by magnitude, saturation and hue of L*a*b*, through white between two colours
};

/// Colour and opacity as functions of the data value, in the form ParaView saves them.
///
/// Of several points at the same x the last one counts at x itself, so that two make a step.
struct TransferFunction {
    struct ColorPoint {
        double x = 0;
        glm::dvec3 rgb{0.0};  ///< each 0..1, in the file's colour space
    };
    struct OpacityPoint {
        double x = 0;
        double opacity = 0;  ///< 0..1, over one unit distance
        double midpoint =
            0.5;  ///< 0..1, where between this point and the next the half-way value lies
        double sharpness = 0;  ///< 0 = linear, 1 = a step
    };
    std::string name;                     ///< what the file calls it, or the file's stem
    std::vector<ColorPoint> colors;       ///< at least one; x not decreasing
    std::vector<OpacityPoint> opacities;  ///< at least one; x not decreasing
    bool normalized = false;    ///< x runs over 0..1 of a data range instead of data values
    bool linearColors = false;  ///< colours are scene-linear; otherwise sRGB
    ColorSpace colorSpace = ColorSpace::kRgb;
    bool categorical = false;  ///< values are labels: nothing lies between two of them

    /// Returns the scene-linear, not premultiplied colour at x. Constant beyond the first and the
    /// last point. What L*a*b* makes of sRGB colours that no screen shows is brought back to what
    /// one does.
    glm::dvec3 colorAt(double x) const;
    /// Returns the opacity 0..1 over one unit distance at x, with midpoint and sharpness as VTK
    /// understands them. Constant beyond the first and the last point.
    double opacityAt(double x) const;
    /// Whether values must not be mixed before they get colours: a colour that is seen changes at
    /// once to another, or values are labels, of which others may lie between any two.
    bool colorsJump() const;
};

/// Reads the first transfer function of a ParaView JSON file (an array of presets, or one object):
/// `Name`, `RGBPoints`, `Points`, `Normalized`, `ColorSpaceOfPoints`, `ColorSpace`; other members
/// are passed over. `ColorSpace` is "RGB", "HSV" (with `HSVWrap`), "Lab" or "CIELAB",
/// "Lab/CIEDE2000", "Diverging" or "Step": each interval has the colour of its right end, which
/// belongs to it; its left end has its own. Others are mixed as RGB, with a warning. Linear colours
/// may be brighter than 1. Without `Points` opacities rise from 0 at the first colour's x to 1 at
/// the last one's, with a warning.
/// @throw Error(kInput) naming file, line and what was expected, if it is missing or malformed
TransferFunction readTransferFunction(const std::filesystem::path& file,
                                      const Listener& listener = {});

/// Returns the ramp used when none is given: clear at rampRange's (default_ramp.h) lower end, with
/// `kRampOpacity` at its upper end, white for fog (isFog), else from black to white; or, where 0
/// stands for nothing and values lie on both sides, clear at 0, blue below, red above. Where both
/// ends are one value, it is dense from there on. A volume with nothing but background is clear.
TransferFunction defaultRamp(const Volume& volume);
inline constexpr double kRampOpacity = 0.1;

/// Returns the grey ramp for largest values when no other is given: black at the smallest and white
/// at the largest active value, grey levels of an sRGB picture in proportion to values between.
TransferFunction wholeRamp(const Volume& volume);

/// Returns the data values that 0 and 1 of a normalized transfer function stand for when nothing
/// else is said: 0..255 for uint8 sources, otherwise the smallest and largest of the active values
/// and, for .vdb grids, the background. A volume of one value only: from 0 to that value, or from
/// that value to 0 if it is negative, or 0..1 if it is zero.
glm::dvec2 defaultRange(const Volume& volume);

}  // namespace deltasplat
