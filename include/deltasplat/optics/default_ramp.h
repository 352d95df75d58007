// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// Whether a volume's values say how much there is of something at a place, as smoke has more or
/// less of it: a .vdb of class fog volume, or one that is named `density` and says nothing of a
/// class. Other values (of a scanner, of a temperature) mean more than their amount.
bool isFog(const Volume& volume);

/// Whether a volume's values are Hounsfield units, as CT scanners give them: it lies in a patient's
/// space (Volume::space), at least a hundredth of it is air (-1100 to -900) and a fiftieth soft
/// tissue (-200 to 300). What is less than air, as what a scanner has not seen, does not matter.
bool isHounsfield(const Volume& volume);

/// Returns where most values lie: from the 1st to the 99th percentile of the active ones other than
/// the background. Both are the same where nearly all are; of a volume with nothing but background
/// they are the background and 1 more.
glm::dvec2 bulkRange(const Volume& volume);

/// Returns the values at which default ramps and presets of a range begin and end: bulkRange, but
/// of fog (isFog) from the background on, for all that is more is there.
glm::dvec2 rampRange(const Volume& volume);

/// Returns a ramp as defaultRamp(volume) is, grey or white, with other ends.
/// @param range  the values that are clear and as dense as the ramp gets; range.x < range.y
TransferFunction defaultRamp(const Volume& volume, const glm::dvec2& range);

/// Returns wholeRamp(volume) with other ends.
/// @param range  the values that are black and white; range.x < range.y
TransferFunction wholeRamp(const Volume& volume, const glm::dvec2& range);

}  // namespace deltasplat
