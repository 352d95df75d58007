// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <string>
#include <utility>
#include <vector>

namespace deltasplat {

/// A .png image: red, green, blue, straight alpha, in sRGB.
struct PngPicture {
    glm::ivec2 size{0};             ///< at least 1x1
    int bits = 8;                   ///< 8 or 16, per sample
    const void* samples = nullptr;  ///< first sample of the first row, as uint8_t or uint16_t
    std::size_t rowBytes = 0;       ///< from one row to the next
    std::vector<std::pair<std::string, std::string>> texts;  ///< keywords (at most 79 bytes), UTF-8
};

/// Returns the file's bytes. Multi-threaded; the bytes do not depend on the number of threads.
std::string encodePng(const PngPicture& picture);

}  // namespace deltasplat
