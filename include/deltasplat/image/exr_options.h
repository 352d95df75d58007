// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

namespace deltasplat {

/// CIE x and y of red, green, blue and white, one after the other.
using Chromaticities = std::array<float, 8>;

/// Those of Rec. 709 and sRGB, with the white point D65.
inline constexpr Chromaticities kRec709{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};

/// How a picture lies in an .exr, and how its numbers are packed.
struct ExrOptions {
    /// Of the picture's first pixel in the display window, whose first one is (0, 0).
    glm::ivec2 dataMin{0};
    /// Size of the display window; empty: the picture's.
    std::optional<glm::ivec2> displaySize;
    /// Stores the part of the picture in which there is something, or one pixel of nothing.
    bool autocrop = false;
    /// One of exrCompressions(); empty: zip. Of a deep picture zips.
    std::string compression;
    /// zip, zips: 1 (fast) to 9 (small), default 4; dwaa, dwab: how much may be lost, default 45.
    std::optional<double> level;
    /// Stores `channels` in parts of their own, one for each layer; not of deep pictures.
    bool multipart = false;
    double pixelAspect = 1;  ///< width of a pixel divided by its height, > 0
    /// Of the colours; empty: none are stored.
    std::optional<Chromaticities> chromaticities = kRec709;
};

/// Returns the names of all ways to pack numbers.
const std::vector<std::string>& exrCompressions();

/// @throw Error(kUsage) naming the option
void checkExrOptions(const ExrOptions& options, bool isDeep);

}  // namespace deltasplat
