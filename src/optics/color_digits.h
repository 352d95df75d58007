// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec4.hpp>

#include "deltasplat/optics/class_table.h"

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

}  // namespace deltasplat
