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

/// All digits of a colour that there may be: of each plane the high one, then the low one.
using ColorDigits = std::array<ClassTable::Color, 2 * ClassTable::kMaxPlanes>;

/// How far rounding may be off, as a share of what is rounded, and of colour by opacity.
inline constexpr double kColorShare = 0x1p-8;
/// What is less belongs on the second plane.
inline constexpr double kLeastOfPlane = double(ClassTable::kMax) / (1 << ClassTable::kPlaneBits);
/// Below 2^-40 of the largest, what is off by no more than at 2^-40 is right.
inline constexpr double kLeastUnits = ClassTable::kMax * 0x1p-40;

/// Writes a premultiplied colour in digits, as ClassTable says.
/// @param units  0..ClassTable::kMax in each channel: units of the first plane
ColorDigits digitsOf(const glm::dvec4& units);

/// Returns what digits stand for, in units of the first plane.
glm::dvec4 unitsOf(const ColorDigits& digits);

/// Returns which digits are not zero: bit i for digits[i].
unsigned usedDigits(const ColorDigits& digits);

/// Tells at which place of a transfer function a data value lies.
class FunctionPlace {
  public:
    /// @param range  of a normalized one; empty: defaultRange of the volume
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

/// Returns the largest share of light that anything can take away on the way through the shortest
/// side of a voxel, 0..1, by the transfer function alone: whatever values the volume has, and
/// whichever side it is seen from.
/// @throw as classify
double largestAlpha(const Volume& volume, const Optics& optics);

/// Returns the world length over which opacities hold.
inline double unitDistanceOf(const Volume& volume, const Optics& optics) {
    return optics.unitDistance.value_or(smallestSize(volume));
}

/// Notes which classes a digit is not zero of.
/// @return whether there are any
bool noteUse(ClassTable::Digit& digit);

/// Gives classes the numbers that others have, if both tell the same codes apart.
/// @return whether they do; if not, nothing is changed
bool takeNumbers(const ClassTable& others, ClassTable& table);

}  // namespace deltasplat
