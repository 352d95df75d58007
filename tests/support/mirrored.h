// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "deltasplat/image/image.h"

namespace deltasplat::test {

/// Returns a picture with left and right exchanged.
inline Image mirrored(const Image& image) {
    Image result = image;
    for (int y = 0; y < image.size.y; ++y) {
        for (int x = 0; x < image.size.x; ++x)
            std::copy_n(image.pixel(image.size.x - 1 - x, y), 4, result.pixel(x, y));
    }
    return result;
}

}  // namespace deltasplat::test
