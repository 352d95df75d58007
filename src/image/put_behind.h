// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/image/image.h"

namespace deltasplat {

/// Puts a picture behind another one, a part of which it covers. Where only one of them shows
/// anything, its bits stay. Multi-threaded.
/// @param first  pixel of the front one that the other begins at
void putBehind(Image& front, glm::ivec2 first, const Image& behind);

}  // namespace deltasplat
