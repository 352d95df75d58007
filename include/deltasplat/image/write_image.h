// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "deltasplat/image/image.h"

namespace deltasplat {

/// How a picture is stored. No clock time goes into a file: the same picture gives the same bytes.
struct ImageFileOptions {
    bool floatExr = false;  ///< .exr: 32-bit float instead of half; not for .png
    int bits = 8;           ///< .png: 8 or 16 a channel; without effect on .exr
    /// .png of 8 bits: rounds up and down in a fixed pattern, so that slow ramps show no steps.
    bool dither = true;
    std::optional<glm::dmat4>
        cameraFromWorld;                     ///< stored as worldToCamera, rounded to float (.exr)
    std::optional<glm::dmat4> ndcFromWorld;  ///< stored as worldToNDC, rounded to float (.exr)
    /// Name, text; each is stored as text named `deltasplat:<name>` (.exr sorts them by name).
    std::vector<std::pair<std::string, std::string>> metadata;
};

/// The most pixels that a side of a .png may have.
inline constexpr int kMaxPngSide = 1'000'000;

/// Throws unless `writeImage` could write a picture of this size under this file name with these
/// options: asked before hours of work.
/// @throw Error(kUsage) for an extension, a size or a bit depth that is not supported, or floats in
/// a .png;
///        Error(kOutput) if the folder does not exist or cannot be written to
void checkImageFile(const std::filesystem::path& file, glm::ivec2 sizePixels,
                    const ImageFileOptions& options);

/// Writes `.exr` (scene-linear, premultiplied, ZIP compression) or `.png` (sRGB, straight alpha,
/// rounded to nearest, or dithered; clear where alpha is 0), by extension in any case. The file
/// appears under its final name only when it is whole. Deterministic, whatever the number of
/// threads.
///
/// NaN is never stored: it becomes 0. In .exr, values beyond the largest finite number of the pixel
/// type (65504 for half) become that number; in .png, alpha and colour are clamped to 0..1 after
/// colour is divided by alpha.
/// @throw Error(kUsage) as checkImageFile, or if the picture has no pixels; Error(kOutput) if it
/// cannot be written
void writeImage(const std::filesystem::path& file, const Image& image,
                const ImageFileOptions& options);

/// Returns the bytes of the file that writeImage would write, without writing any.
/// @throw as writeImage
std::string encodeImage(const std::filesystem::path& file, const Image& image,
                        const ImageFileOptions& options);

/// Puts a background colour (scene-linear, straight alpha) behind the picture:
/// C += (1 - A) * background.rgb * background.a; A += (1 - A) * background.a.
void compositeOver(Image& image, const glm::vec4& background);

}  // namespace deltasplat
