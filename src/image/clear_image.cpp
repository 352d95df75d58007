// SPDX-License-Identifier: Apache-2.0
#include "image/clear_image.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "parallel.h"

namespace deltasplat {
namespace {

// Where the system cannot be asked, memory comes when it is written to.
void askForMemory([[maybe_unused]] void* first, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_POPULATE_WRITE
    constexpr std::size_t kPart = std::size_t{2} << 20;
    const auto page = std::uintptr_t(::sysconf(_SC_PAGESIZE));
    const std::uintptr_t begin = (std::uintptr_t(first) + page - 1) / page * page;
    const std::uintptr_t end = (std::uintptr_t(first) + bytes) / page * page;
    if (end < begin + 2 * kPart) return;
    parallelFor((end - begin + kPart - 1) / kPart, [&](std::size_t part) {
        const std::uintptr_t from = begin + part * kPart;
        ::madvise(reinterpret_cast<void*>(from), std::min(kPart, end - from), MADV_POPULATE_WRITE);
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

}  // namespace deltasplat
