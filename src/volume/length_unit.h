// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace deltasplat {

/// Returns the name that Volume::lengthUnit has for a unit of length as files write it ("microns",
/// "µm", "Millimeter", "inch"), in any case; empty for what is no unit of length.
std::string lengthUnitNamed(const std::string& text);

/// Returns how many millimetres a unit of Volume::lengthUnit is; 0 for an unknown one.
double millimetresIn(const std::string& lengthUnit);

}  // namespace deltasplat
