// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/image/image.h"
#include "drawing/drawing.h"

namespace deltasplat {

/// Returns the sRGB colour of a share 0..1 of the scale, from nearly black over violet and red to
/// pale yellow: brighter is more, in grey print as well. Beyond the scale it is that of its end.
Rgb heatColor(double share);

/// Returns the CSS gradient, from left to right, that heatColor runs through.
std::string heatGradient();

/// Returns an opaque picture of how far two pictures of the same size are apart: for each pixel the
/// largest absolute difference of a channel, as a share of `full`; 0 everywhere if that is 0.
Image heatMap(const Image& a, const Image& b, double full);

}  // namespace deltasplat
