// SPDX-License-Identifier: Apache-2.0
// Based on: Thomas Porter and Tom Duff, "Compositing Digital Images", 1984, the operator over.
#include "image/put_behind.h"

#include <algorithm>

#include "parallel.h"

namespace deltasplat {

void putBehind(Image& front, glm::ivec2 first, const Image& behind) {
    const auto isClear = [](const float* rgba) {
        return std::all_of(rgba, rgba + 4, [](float value) { return value == 0; });
    };
    parallelForChunks(std::size_t(behind.size.y), [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            float* out = front.pixel(first.x, first.y + int(y));
            const float* rgba = behind.pixel(0, int(y));
            for (int x = 0; x < behind.size.x; ++x, out += 4, rgba += 4) {
                if (isClear(rgba)) continue;
                if (isClear(out)) {
                    std::copy_n(rgba, 4, out);
                    continue;
                }
                const float left = 1 - out[3];
                for (int c = 0; c < 4; ++c) out[c] += left * rgba[c];
            }
        }
    });
}

}  // namespace deltasplat
