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

/// Space in which colours between two points of a transfer function are mixed, as in VTK.
enum class ColorSpace {
    kRgb,          ///< as they are given
    kHsv,          ///< hue, through all hues between the two, saturation and value
    kHsvShortest,  ///< likewise, by the shorter way around the circle of hues
    kLab,          ///< CIE L*a*b*
    kDiverging     ///< magnitude, saturation and hue of L*a*b*, through white
};

/// Colour and opacity as functions of the data value, in ParaView's form. Of several points at one
/// x the last counts at x itself, so two points make a step.
struct TransferFunction {
    struct ColorPoint {
        double x = 0;
        glm::dvec3 rgb{0.0};  ///< each 0..1, in the file's colour space
    };
    struct OpacityPoint {
        double x = 0;
        double opacity = 0;  ///< 0..1, over one unit distance
        /// 0..1, where between this point and the next the half-way value lies.
        double midpoint = 0.5;
        double sharpness = 0;  ///< 0 = linear, 1 = a step
    };
    std::string name;                     ///< what the file calls it, or the file's stem
    std::vector<ColorPoint> colors;       ///< at least one; x not decreasing
    std::vector<OpacityPoint> opacities;  ///< at least one; x not decreasing
    bool normalized = false;    ///< x runs over 0..1 of a data range instead of data values
    bool linearColors = false;  ///< colours are scene-linear; otherwise sRGB
    ColorSpace colorSpace = ColorSpace::kRgb;
    bool categorical = false;  ///< values are labels: nothing lies between two of them

    /// Returns the scene-linear, not premultiplied colour at x. Constant beyond the first and last
    /// point. sRGB colours mixed in L*a*b* are brought into what screens can show.
    glm::dvec3 colorAt(double x) const;
    /// Returns the opacity 0..1 over one unit distance at x, with VTK's midpoint and sharpness.
    /// Constant beyond the first and last point.
    double opacityAt(double x) const;
    /// Whether values must get colours before they are mixed: a visible colour jumps, or values are
    /// labels, between any two of which other labels may lie.
    bool colorsJump() const;
};

/// Reads the first transfer function of a ParaView JSON file (an array of presets, or one object):
/// `Name`, `RGBPoints`, `Points`, `Normalized`, `ColorSpaceOfPoints`, `ColorSpace`; other members
/// are ignored. `ColorSpace` is "RGB", "HSV" (with `HSVWrap`), "Lab" or "CIELAB", "Lab/CIEDE2000",
/// "Diverging" or "Step", in which an interval has the colour of its right end, right end included.
/// Other spaces are mixed as RGB, with a warning. Linear colours may be brighter than 1. Without
/// `Points` opacities rise from 0 at the first colour's x to 1 at the last's, with a warning.
/// @throw Error(kInput) naming file, line and what was expected, if it is missing or malformed
TransferFunction readTransferFunction(const std::filesystem::path& file,
                                      const Listener& listener = {});

/// Returns the default ramp: clear at rampRange's (default_ramp.h) lower end, `kRampOpacity` at its
/// upper end, white for fog (isFog), else black to white. Where 0 is the background and values lie
/// on both sides: clear at 0, blue below, red above. Where both ends are one value, it is dense
/// from that value on. A volume of background only is clear.
TransferFunction defaultRamp(const Volume& volume);
inline constexpr double kRampOpacity = 0.1;

/// Returns the default grey ramp for largest values: black at the smallest and white at the largest
/// active value; grey levels of an sRGB picture are proportional to values.
TransferFunction wholeRamp(const Volume& volume);

/// Returns the default data values for 0 and 1 of a normalized transfer function: 0..255 for uint8
/// sources, otherwise smallest and largest of the active values and, for .vdb grids, the
/// background. A volume of one value v: 0..v, v..0 if v is negative, 0..1 if v is 0.
glm::dvec2 defaultRange(const Volume& volume);

}  // namespace deltasplat
