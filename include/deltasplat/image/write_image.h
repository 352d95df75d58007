// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "deltasplat/image/exr_options.h"
#include "deltasplat/image/image.h"
#include "deltasplat/image/pixel_box.h"

namespace deltasplat {

/// A channel beside R, G, B and A.
struct ImageChannel {
    std::string name;
    std::vector<float> values;  ///< [height][width], from the top
    float nothing = 0;          ///< value of empty pixels
};

/// How a picture is stored. Files hold no clock time: equal pictures give equal bytes.
struct ImageFileOptions {
    bool floatExr = false;  ///< .exr only: 32-bit float instead of half
    /// Stores the first channel as 32-bit floats: in .tif; .npy, .nrrd and .mha hold nothing else.
    bool numbers = false;
    float nothing = 0;  ///< with `numbers`: stored where alpha is 0; 0: the number
    /// .nrrd, .mha: maps the centre of a pixel, (column, row, 0), to its world position.
    std::optional<glm::dmat4> worldFromPixel;
    std::string space;       ///< of that world, as Volume::space
    std::string lengthUnit;  ///< of that world, as Volume::lengthUnit; .mha holds mm
    int bits = 8;            ///< .png, .tif: 8 or 16 a channel; .jpg: 8; without effect on .exr
    /// 8 bits: rounds up and down in a fixed pattern, so that slow ramps show no steps.
    bool dither = true;
    std::optional<glm::dmat4>
        cameraFromWorld;                     ///< stored as worldToCamera, rounded to float (.exr)
    std::optional<glm::dmat4> ndcFromWorld;  ///< stored as worldToNDC, rounded to float (.exr)
    /// Name, text; stored as text `deltasplat:<name>` (.exr sorts by name). In .tif and .jpg, lines
    /// `deltasplat:<name>: <text>` of the image description, in .jpg its first 30000 bytes.
    std::vector<std::pair<std::string, std::string>> metadata;
    /// .exr: stored beside R, G, B and A, always as finite floats.
    std::vector<ImageChannel> channels;
    ExrOptions exr;
    std::optional<PixelBox> region;  ///< stored part of the picture; empty: all
};

enum class ImageFormat { kExr, kPng, kTiff, kJpeg, kNpy, kNrrd, kMetaImage };

/// Returns a file's format by its extension, in any case: .exr, .png, .tif, .tiff, .jpg, .jpeg; for
/// numbers .npy, .nrrd, .mha.
/// @throw Error(kUsage) for others
ImageFormat imageFormatOf(const std::filesystem::path& file);

/// Largest side of a .png or .tif, in pixels.
inline constexpr int kMaxPngSide = 1'000'000;
/// Largest side of a .jpg, by its format.
inline constexpr int kMaxJpegSide = 65500;

/// Throws unless `writeImage` could write a picture of this size, before hours of work.
/// @throw Error(kUsage) for an unsupported extension, size or bit depth, or floats outside .exr;
///        Error(kOutput) if the folder does not exist or cannot be written to
void checkImageFile(const std::filesystem::path& file, glm::ivec2 sizePixels,
                    const ImageFileOptions& options);

/// Whether a format holds only pictures of numbers.
bool isOfNumbers(ImageFormat format);

/// Writes `.exr` (scene-linear, premultiplied), `.png` or `.tif` (sRGB, straight alpha, rounded to
/// nearest, or dithered; clear where alpha is 0) or `.jpg` (sRGB, over black, quality 95 without
/// subsampling), by imageFormatOf. The file appears under its final name only when it is whole.
/// Deterministic, whatever the number of threads.
///
/// NaN becomes 0. In .exr, values beyond the pixel type's largest finite number (65504 for half)
/// become that number; elsewhere alpha, and colour divided by alpha, are clamped to 0..1.
/// @throw Error(kUsage) as checkImageFile, or without pixels; Error(kOutput) if writing fails
void writeImage(const std::filesystem::path& file, const Image& image,
                const ImageFileOptions& options);

/// Returns the file's bytes instead of writing them.
/// @throw as writeImage
std::string encodeImage(const std::filesystem::path& file, const Image& image,
                        const ImageFileOptions& options);

/// Puts a background colour (scene-linear, straight alpha) behind the picture:
/// C += (1 - A) * background.rgb * background.a; A += (1 - A) * background.a.
void compositeOver(Image& image, const glm::vec4& background);

}  // namespace deltasplat
