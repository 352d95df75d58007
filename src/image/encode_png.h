// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <string>
#include <utility>
#include <vector>

namespace deltasplat {

/// A .png of red, green, blue and straight alpha, in sRGB.
struct PngPicture {
    glm::ivec2 size{0};             ///< at least 1x1
    int bits = 8;                   ///< or 16: of a sample
    const void* samples = nullptr;  ///< the first row's first, as uint8_t or uint16_t
    std::size_t rowBytes = 0;       ///< from one row to the next
    /// Keywords, of at most 79 bytes, and what they stand for, in UTF-8.
    std::vector<std::pair<std::string, std::string>> texts;
};

/// Returns the bytes of the file. Rows are packed in blocks, by all threads; the bytes are the same
/// however many there are.
std::string encodePng(const PngPicture& picture);

}  // namespace deltasplat
