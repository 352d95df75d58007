// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "deltasplat/image/image.h"

namespace deltasplat {

/// What becomes of scene-linear light in a file that holds 0 to 1.
enum class Tone {
    kStandard,  ///< it stays as it is, and what is above 1 is clipped
    kFilmic,    ///< highlights roll off to white, as on film: toneFilmic
};

/// "standard" or "filmic".
std::string toneName(Tone tone);

/// The most stops that light can be made brighter or darker by.
inline constexpr double kMaxExposureStops = 100;

/// Multiplies colour, not alpha, by 2^exposureStops, exactly for whole numbers of stops; what would
/// be beyond the finite numbers of float becomes the largest.
/// @param exposureStops  within -kMaxExposureStops..kMaxExposureStops
/// @throw Error(kUsage) for others. Deterministic, whatever the number of threads.
void expose(Image& image, double exposureStops);

/// Turns light into what is to be shown of it, 0 to 1, by S. Hill's fit of the ACES film curve: see
/// docs/method.md#light-on-a-screen. Black stays black and grey grey, 0.18 stays 0.18 (within
/// 0.0001), and what is 17.6 or more is white. NaN and what is below 0 count as 0.
///
/// It is the premultiplied colour that is turned, as it is seen over black. Where less than all is
/// covered, alpha grows to the largest channel of what comes out, so that no colour is above alpha:
/// over black the picture is what was made, what is clear stays clear, and what is opaque opaque.
/// Deterministic, whatever the number of threads.
void toneFilmic(Image& image);

/// Returns which share of the pixels that are not clear is clipped in files of 8 and 16 bits: a
/// colour of theirs is above alpha by more than 1/256, which can be seen. 0 if all is clear.
double clippedShare(const Image& image);

/// Returns how many pixels have a channel beyond 65504, the most that the halves of an .exr hold.
std::size_t countBeyondHalf(const Image& image);

}  // namespace deltasplat
