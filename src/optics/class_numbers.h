// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/optics/class_table.h"

namespace deltasplat {

/// Notes which classes a digit is not zero of.
/// @return whether there are any
bool noteUse(ClassTable::Digit& digit);

/// Gives classes the numbers that others have, if both tell the same codes apart.
/// @return whether they do; if not, nothing is changed
bool takeNumbers(const ClassTable& others, ClassTable& table);

}  // namespace deltasplat
