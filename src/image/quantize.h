// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

#include "base/uncleared.h"
#include "deltasplat/image/image.h"

namespace deltasplat {

/// The largest number that 16-bit floats hold.
inline constexpr float kLargestHalf = 65504;

/// Returns a number that files hold: NaN as 0, and what is larger than they know as the largest.
inline float finiteValue(float value, float largest = std::numeric_limits<float>::max()) {
    return std::isnan(value) ? 0.0f : std::clamp(value, -largest, largest);
}

/// Returns the picture as `[height][width][4]` samples with straight alpha and sRGB colour, rounded
/// to nearest: 0 is 0 and 1 is the largest number of `Sample` (uint8_t or uint16_t).
/// @param dither  round up or down instead, by a fixed pattern of places in the picture, so that
///                the mean of neighbouring pixels is right; what is a whole number stays so
template <typename Sample>
UnclearedVector<Sample> straightSrgb(const Image& image, bool dither = false);

/// The same of the picture over black, without alpha: `[height][width][3]`.
UnclearedVector<std::uint8_t> opaqueSrgb(const Image& image, bool dither);

/// Returns a small copy of a picture that was written: of a whole number of its pixels each way the
/// mean, of its display window, as light. Read some rows at a time.
/// @param mostSide  pixels that its longer side has at most
/// @return an image without pixels if the file is deep, or cannot be read
Image readThumbnail(const std::filesystem::path& file, int mostSide);

/// Returns a picture over black as a .jpg of little size.
/// @throw Error(kOutput) if it cannot be encoded
std::string encodeThumbnail(const Image& image);

/// Whether a file is an image of which all pixels can be read: not cut short by a copy that broke
/// off, and not another kind of file.
bool isWholeImage(const std::filesystem::path& file);

}  // namespace deltasplat
