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
    bool floatExr = false;            ///< .exr: 32-bit float instead of half
    int bits = 8;                     ///< .png: 8 or 16 a channel
    glm::dmat4 cameraFromWorld{1.0};  ///< stored as worldToCamera (.exr)
    glm::dmat4 ndcFromWorld{1.0};     ///< stored as worldToNDC (.exr)
    std::vector<std::pair<std::string, std::string>>
        metadata;  ///< name, text; stored in this order
};

/// Throws unless `writeImage` could write this file name with these options: asked before hours of
/// work.
/// @throw Error(kUsage) for an extension or a bit depth that is not supported;
///        Error(kOutput) if the folder does not exist or cannot be written to
void checkImageFile(const std::filesystem::path& file, const ImageFileOptions& options);

/// Writes `.exr` (scene-linear, premultiplied) or `.png` (sRGB, straight alpha, rounded to
/// nearest). The file appears under its final name only when it is whole.
/// @throw Error(kUsage) as checkImageFile; Error(kOutput) if it cannot be written
void writeImage(const std::filesystem::path& file, const Image& image,
                const ImageFileOptions& options);

/// Puts a background colour (scene-linear, straight alpha) behind the picture.
void compositeOver(Image& image, const glm::vec4& background);

}  // namespace deltasplat
