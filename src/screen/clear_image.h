// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include "deltasplat/image/image.h"

namespace deltasplat {

/// Returns a picture of zeros, like Image's constructor. All threads request the memory from the
/// system, which takes longer than writing the zeros.
Image clearImage(glm::ivec2 size);
/// Clears a picture, on all threads.
void clearImage(Image& image);

/// Puts a picture behind a part of another. Bits of only one of them stay. Multi-threaded.
/// @param first  pixel of the front picture where the other one begins
void putBehind(Image& front, glm::ivec2 first, const Image& behind);

}  // namespace deltasplat
