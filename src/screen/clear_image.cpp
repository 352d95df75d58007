// SPDX-License-Identifier: Apache-2.0
// Based on: Thomas Porter and Tom Duff, "Compositing Digital Images", 1984, the operator over.
#include "screen/clear_image.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/parallel.h"

namespace deltasplat {

namespace {

// Without this system call, memory comes when it is written to.
void askForMemory([[maybe_unused]] void* first, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_POPULATE_WRITE
    constexpr std::size_t kPart = std::size_t{2} << 20;
    constexpr std::size_t kMostPage = std::size_t{64} << 10;
    if (bytes < 4 * kPart) return;
    // From the first whole page on.
    char* begin = static_cast<char*>(first) + kMostPage - std::uintptr_t(first) % kMostPage;
    const std::size_t whole = (bytes - 2 * kMostPage) / kMostPage * kMostPage;
    parallelFor((whole + kPart - 1) / kPart, [&](std::size_t part) {
        const std::size_t from = part * kPart;
        ::madvise(begin + from, std::min(kPart, whole - from), MADV_POPULATE_WRITE);
    });
#endif
}

}  // namespace

Image clearImage(glm::ivec2 size) {
    Image image;
    image.size = size;
    const std::size_t values = std::size_t{4} * std::size_t(size.x) * std::size_t(size.y);
    image.rgba.reserve(values);
    askForMemory(image.rgba.data(), values * sizeof(float));
    image.rgba.resize(values);
    return image;
}

void clearImage(Image& image) {
    const std::size_t ofRow = std::size_t{4} * std::size_t(image.size.x);
    parallelForChunks(std::size_t(image.size.y), [&](std::size_t begin, std::size_t end) {
        std::fill_n(image.rgba.data() + ofRow * begin, ofRow * (end - begin), 0.0f);
    });
}

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
