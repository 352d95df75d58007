// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "deltasplat/image/deep_image.h"
#include "deltasplat/image/write_image.h"

namespace deltasplat {

/// Throws unless `writeDeepImage` could write a picture of this size under this file name.
/// @throw Error(kUsage) for an extension other than .exr or a size that is not supported;
///        Error(kOutput) if the folder does not exist or cannot be written to
void checkDeepImageFile(const std::filesystem::path& file, glm::ivec2 sizePixels,
                        const ImageFileOptions& options);

/// Writes a deep .exr by scanlines (ZIPS compression): channels R, G, B, A as halves, or floats if
/// `options.floatExr`, Z and ZBack as floats; attributes as in a flat .exr. The file appears under
/// its final name only when it is whole. Deterministic, whatever the number of threads.
///
/// NaN becomes 0. Values beyond the channel type's largest finite number become that number. A
/// sample whose colour and alpha would all be stored as 0 is left out. Halves are rounded so that
/// stacked samples keep their result, within 2^-12 of 1.
/// @throw Error(kUsage) as checkDeepImageFile, or if the picture has no pixels; Error(kFailed) if
///        it does not fit this machine's memory; Error(kOutput) if it cannot be written
void writeDeepImage(const std::filesystem::path& file, const DeepImage& image,
                    const ImageFileOptions& options);

/// Returns the file's bytes instead of writing them.
/// @throw as writeDeepImage
std::string encodeDeepImage(const std::filesystem::path& file, const DeepImage& image,
                            const ImageFileOptions& options);

}  // namespace deltasplat
