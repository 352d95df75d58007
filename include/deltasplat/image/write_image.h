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

/// A channel beside a picture's own.
struct ImageChannel {
    std::string name;
    std::vector<float> values;  ///< [height][width], from the top
    float nothing = 0;          ///< what it tells where there is nothing
};

/// How a picture is stored. No clock time goes into a file: the same picture gives the same bytes.
struct ImageFileOptions {
    bool floatExr = false;  ///< .exr: 32-bit float instead of half; not for others
    /// .npy, .nrrd and .mha, which hold no other pictures, and .tif: the picture is one of numbers,
    /// of which the first channel is stored, as 32-bit floats.
    bool numbers = false;
    float nothing = 0;  ///< of `numbers`: what is stored where alpha is 0; 0: the number
    /// .nrrd, .mha: maps the centre of a pixel, (column, row, 0), to its place in the world.
    std::optional<glm::dmat4> worldFromPixel;
    std::string space;       ///< of that world, as Volume::space
    std::string lengthUnit;  ///< of that world, as Volume::lengthUnit; .mha holds mm
    int bits = 8;            ///< .png, .tif: 8 or 16 a channel; .jpg: 8; without effect on .exr
    /// 8 bits: rounds up and down in a fixed pattern, so that slow ramps show no steps.
    bool dither = true;
    std::optional<glm::dmat4>
        cameraFromWorld;                     ///< stored as worldToCamera, rounded to float (.exr)
    std::optional<glm::dmat4> ndcFromWorld;  ///< stored as worldToNDC, rounded to float (.exr)
    /// Name, text; each is stored as text named `deltasplat:<name>` (.exr sorts them by name). In
    /// .tif and .jpg, which have no such names, all are lines `deltasplat:<name>: <text>` of the
    /// image description, of which a .jpg keeps the first 30000 bytes.
    std::vector<std::pair<std::string, std::string>> metadata;
    /// .exr: stored beside R, G, B and A, always as floats, finite as these.
    std::vector<ImageChannel> channels;
    ExrOptions exr;                  ///< without effect on others
    std::optional<PixelBox> region;  ///< what is stored of the picture; empty: all
};

enum class ImageFormat { kExr, kPng, kTiff, kJpeg, kNpy, kNrrd, kMetaImage };

/// Returns the format of a file name, by its extension in any case: .exr, .png, .tif or .tiff, .jpg
/// or .jpeg, and of numbers .npy, .nrrd or .mha.
/// @throw Error(kUsage) for others
ImageFormat imageFormatOf(const std::filesystem::path& file);

/// The most pixels that a side of a .png or .tif may have.
inline constexpr int kMaxPngSide = 1'000'000;
/// The same of a .jpg, as its format has it.
inline constexpr int kMaxJpegSide = 65500;

/// Throws unless `writeImage` could write a picture of this size under this file name with these
/// options: asked before hours of work.
/// @throw Error(kUsage) for an extension, a size or a bit depth that is not supported, or floats in
/// anything but an .exr;
///        Error(kOutput) if the folder does not exist or cannot be written to
void checkImageFile(const std::filesystem::path& file, glm::ivec2 sizePixels,
                    const ImageFileOptions& options);

/// Returns whether a format holds pictures of numbers alone.
bool isOfNumbers(ImageFormat format);

/// Writes `.exr` (scene-linear, premultiplied), `.png` or `.tif` (sRGB, straight
/// alpha, rounded to nearest, or dithered; clear where alpha is 0) or `.jpg` (sRGB, over black,
/// quality 95 without subsampling), by extension as imageFormatOf has it. The file
/// appears under its final name only when it is whole. Deterministic, whatever the number of
/// threads.
///
/// NaN is never stored: it becomes 0. In .exr, values beyond the largest finite number of the pixel
/// type (65504 for half) become that number; in others, alpha and colour are clamped to 0..1 after
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
