// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include "deltasplat/image/image.h"

namespace deltasplat {

/// Returns a picture of zeros, as Image's constructor makes it. All threads ask the system for its
/// memory, which takes longer than the zeros that one of them writes then.
Image clearImage(glm::ivec2 size);
/// Makes a picture all zero, on all threads.
void clearImage(Image& image);

/// Puts a picture behind another one, a part of which it covers. Where only one of them shows
/// anything, its bits stay. Multi-threaded.
/// @param first  pixel of the front one that the other begins at
void putBehind(Image& front, glm::ivec2 first, const Image& behind);

}  // namespace deltasplat
