// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "annotate/annotation.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

/// A bar of a known world length.
struct ScaleBar {
    double lengthWorld = 0;   ///< 1, 2 or 5 times a power of ten
    double lengthPixels = 0;  ///< at most three tenths of the picture's width
    std::string label;        ///< the length and its unit, and where it holds
};

/// Returns the bar of a camera that is not kLatlong; in perspective it holds at the target's
/// distance.
/// @param lengthUnit  as Volume::lengthUnit: what is less than one of it is said in smaller units,
///                    as many of which as the length is
ScaleBar scaleBarOf(const Camera& camera, const std::string& lengthUnit);

/// Puts the bar into the lower right corner.
Annotation drawScaleBar(const ScaleBar& bar, const AnnotationStyle& style);

}  // namespace deltasplat
