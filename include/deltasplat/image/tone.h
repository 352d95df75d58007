// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "deltasplat/image/image.h"

namespace deltasplat {

/// How scene-linear light becomes file values of 0 to 1.
enum class Tone {
    kStandard,  ///< unchanged, and clipped above 1
    kFilmic,    ///< highlights roll off to white, as on film: toneFilmic
};

std::string toneName(Tone tone);

/// Largest change of exposure, in stops, either way.
inline constexpr double kMaxExposureStops = 100;

/// Multiplies colour, not alpha, by 2^exposureStops, exactly for whole stops; results beyond
/// float's finite numbers become the largest one. Deterministic, whatever the number of threads.
/// @param exposureStops  within -kMaxExposureStops..kMaxExposureStops
/// @throw Error(kUsage) outside that range
void expose(Image& image, double exposureStops);

/// Turns light into display values, 0 to 1, by S. Hill's fit of the ACES film curve: see
/// docs/method.md#light-on-a-screen. Black stays black and grey grey, 0.18 stays 0.18 (within
/// 0.0001), and 17.6 or more is white. NaN and values below 0 count as 0.
///
/// The curve applies to premultiplied colour, as seen over black. Below full cover alpha grows to
/// the largest resulting channel, so that no colour is above alpha: the picture over black is as
/// computed, clear pixels stay clear, opaque ones opaque. Deterministic for any thread count.
void toneFilmic(Image& image);

/// Returns the share of the pixels that are not clear which 8- and 16-bit files clip visibly: some
/// colour exceeds alpha by more than 1/256. 0 if all are clear.
double clippedShare(const Image& image);

/// Returns the number of pixels with a channel beyond 65504, the largest half of an .exr.
std::size_t countBeyondHalf(const Image& image);

}  // namespace deltasplat
