// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace deltasplat {

/// The filter from base plane to picture. Widths are in pixels, of the coarser of the two.
enum class PictureFilter {
    kCatmullRom,  ///< sharp; keeps pixels of the base plane exactly
    kMitchell,    ///< a little softer (Mitchell and Netravali's B = C = 1/3)
    kGauss,       ///< soft: standard deviation 1/2, ends at 3/2; no weight is negative
    kBox          ///< the mean over a pixel's square; linear where the picture is finer
};

/// Returns "catmull-rom", "mitchell", "gauss" or "box".
std::string pictureFilterName(PictureFilter filter);

}  // namespace deltasplat
