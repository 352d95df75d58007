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

/// The largest finite 16-bit float.
inline constexpr float kLargestHalf = 65504;

/// Returns a value that files hold: NaN becomes 0, larger values the largest.
inline float finiteValue(float value, float largest = std::numeric_limits<float>::max()) {
    return std::isnan(value) ? 0.0f : std::clamp(value, -largest, largest);
}

/// Returns the picture as `[height][width][4]` samples with straight alpha and sRGB colour, rounded
/// to nearest: 1 becomes the largest `Sample` (uint8_t or uint16_t).
/// @param dither  round by a fixed pattern instead, which keeps whole numbers and local means
template <typename Sample>
UnclearedVector<Sample> straightSrgb(const Image& image, bool dither = false);

/// Returns the picture over black, without alpha: `[height][width][3]`.
UnclearedVector<std::uint8_t> opaqueSrgb(const Image& image, bool dither);

/// Returns a small copy of a written picture's display window. Each pixel is the mean, in linear
/// light, of a square of pixels. Reads a few rows at a time.
/// @param mostSide  most pixels of the longer side
/// @return an image without pixels if the file is deep, tiled, or cannot be read
Image readThumbnail(const std::filesystem::path& file, int mostSide);

/// Returns a small .jpg of a picture over black.
/// @throw Error(kOutput) if it cannot be encoded
std::string encodeThumbnail(const Image& image);

/// Whether all pixels of an image file can be read; false for a truncated copy or another kind.
bool isWholeImage(const std::filesystem::path& file);

}  // namespace deltasplat
