// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec4.hpp>

#include "deltasplat/optics/class_table.h"

namespace deltasplat {

/// All digits of a colour that there may be: of each plane the high one, then the low one.
using ColorDigits = std::array<ClassTable::Color, 2 * ClassTable::kMaxPlanes>;

/// Writes a premultiplied colour in digits, as ClassTable says.
/// @param units  0..ClassTable::kMax in each channel: units of the first plane
ColorDigits digitsOf(const glm::dvec4& units);

/// Returns what digits stand for, in units of the first plane.
glm::dvec4 unitsOf(const ColorDigits& digits);

/// Returns which digits are not zero: bit i for digits[i].
unsigned usedDigits(const ColorDigits& digits);

}  // namespace deltasplat
