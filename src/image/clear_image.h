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

}  // namespace deltasplat
