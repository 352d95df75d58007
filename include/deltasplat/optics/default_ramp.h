// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// Whether a volume's values are amounts of something, such as smoke: a .vdb of class fog volume,
/// or one named `density` without a class. A scanner's values and temperatures are none.
bool isFog(const Volume& volume);

/// Whether a volume's values are Hounsfield units of a CT scanner: it lies in a patient's space
/// (Volume::space), and at least a hundredth is air (-1100 to -900) and a fiftieth soft tissue
/// (-200 to 300). Values below air, where a scanner saw nothing, do not matter.
bool isHounsfield(const Volume& volume);

/// Returns the 1st and 99th percentile of the active values other than the background, equal if
/// nearly all values are. For a volume of background only: the background and 1 more.
glm::dvec2 bulkRange(const Volume& volume);

/// Returns the values at which default ramps and range presets begin and end: bulkRange, but for
/// fog (isFog) from the background on, because all larger values are fog.
glm::dvec2 rampRange(const Volume& volume);

/// Returns defaultRamp(volume), grey or white, with other ends.
/// @param range  the clear and the densest value; range.x < range.y
TransferFunction defaultRamp(const Volume& volume, const glm::dvec2& range);

/// Returns wholeRamp(volume) with other ends.
/// @param range  the values that are black and white; range.x < range.y
TransferFunction wholeRamp(const Volume& volume, const glm::dvec2& range);

}  // namespace deltasplat
