// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <optional>

#include "base/affine.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/class_table.h"
#include "deltasplat/optics/transfer_function.h"
#include "volume/placement.h"

namespace deltasplat {

/// All possible digits of a colour: per plane the high digit, then the low digit.
using ColorDigits = std::array<ClassTable::Color, 2 * ClassTable::kMaxPlanes>;

/// The largest relative error of rounding, of each channel and of colour divided by opacity.
inline constexpr double kColorShare = 0x1p-8;
/// Smaller channels go to the second plane.
inline constexpr double kLeastOfPlane = double(ClassTable::kMax) / (1 << ClassTable::kPlaneBits);
/// Channels below 2^-40 of the largest may be off by as much as a channel of 2^-40 may.
inline constexpr double kLeastUnits = ClassTable::kMax * 0x1p-40;

/// Splits a premultiplied colour into digits (see ClassTable).
/// @param units  0..ClassTable::kMax in each channel: units of the first plane
ColorDigits digitsOf(const glm::dvec4& units);

/// Returns the colour of digits, in units of the first plane.
glm::dvec4 unitsOf(const ColorDigits& digits);

/// Returns which digits are not zero: bit i for digits[i].
unsigned usedDigits(const ColorDigits& digits);

/// Maps a data value to its place on the transfer function's axis.
class FunctionPlace {
  public:
    /// @param range  for a normalized function; empty: defaultRange of the volume
    FunctionPlace(const TransferFunction& function, const Volume& volume,
                  const std::optional<glm::dvec2>& range)
        : isNormalized_(function.normalized),
          range_(function.normalized ? range.value_or(defaultRange(volume)) : glm::dvec2(0, 1)) {}

    double operator()(double value) const {
        if (!isNormalized_) return value;
        return (0.5 * value - 0.5 * range_.x) / (0.5 * range_.y - 0.5 * range_.x);
    }

  private:
    bool isNormalized_;
    glm::dvec2 range_;
};

/// Returns an upper bound, 0..1, of the share of light that any voxel absorbs along its shortest
/// side. The histogram does not matter, only the transfer function or `densityScale`.
/// @throw as classify
double largestAlpha(const Volume& volume, const Optics& optics);

/// Returns the world length over which opacities hold.
inline double unitDistanceOf(const Volume& volume, const Optics& optics) {
    return optics.unitDistance.value_or(smallestSize(volume));
}

/// Notes the range of classes whose digit is not zero; returns whether there are any.
bool noteUse(ClassTable::Digit& digit);

/// Gives the classes of `table` the numbers of `others`; false if codes are grouped differently.
bool takeNumbers(const ClassTable& others, ClassTable& table);

}  // namespace deltasplat
