// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "deltasplat/image/deep_image.h"
#include "deltasplat/image/image.h"
#include "deltasplat/image/pixel_box.h"
#include "deltasplat/image/write_image.h"

namespace deltasplat {

/// Returns the least box around all pixels of a part that are not clear, or at which a channel
/// tells of something; empty if there are none. Multi-threaded.
PixelBox seenBox(const Image& image, const PixelBox& within,
                 std::span<const ImageChannel> channels);
/// The same of pixels that have samples.
PixelBox seenBox(const DeepImage& image, const PixelBox& within);

/// The same of rows whose first and last pixel seen are known.
/// @param spans  of each row from `first` on pixels [x, y), none if y <= x
PixelBox boxOfRows(int first, std::span<const glm::ivec2> spans);

/// Returns the part of a picture that is stored: all of it, its region, or what is seen of that, at
/// least one pixel.
/// @param seenIn  what is seen in a box
template <typename SeenIn>
PixelBox storedBox(const ImageFileOptions& options, glm::ivec2 size, const SeenIn& seenIn) {
    const PixelBox part = options.region.value_or(PixelBox{{0, 0}, size});
    if (!options.exr.autocrop) return part;
    const PixelBox seen = seenIn(part);
    return seen.empty() ? PixelBox{part.min, part.min + 1} : seen;
}

}  // namespace deltasplat
