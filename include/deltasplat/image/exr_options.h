// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

namespace deltasplat {

/// CIE x and y of red, green, blue and white, in this order.
using Chromaticities = std::array<float, 8>;

/// Rec. 709 and sRGB, with the white point D65.
inline constexpr Chromaticities kRec709{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};

/// Layout and packing of a picture in an .exr.
struct ExrOptions {
    /// Position of the first pixel in the display window, which begins at (0, 0).
    glm::ivec2 dataMin{0};
    /// Size of the display window; empty: the picture's.
    std::optional<glm::ivec2> displaySize;
    /// Stores only the part that is not empty, or one empty pixel.
    bool autocrop = false;
    /// One of exrCompressions(); empty: zip, or zips for deep pictures.
    std::string compression;
    /// zip, zips: 1 (fast) to 9 (small), default 4; dwaa, dwab: loss, default 45.
    std::optional<double> level;
    /// Stores `channels` in a part per layer; not for deep pictures.
    bool multipart = false;
    double pixelAspect = 1;  ///< width of a pixel divided by its height, > 0
    /// Empty: none are stored.
    std::optional<Chromaticities> chromaticities = kRec709;
};

const std::vector<std::string>& exrCompressions();

/// @throw Error(kUsage) naming the option
void checkExrOptions(const ExrOptions& options, bool isDeep);

}  // namespace deltasplat
