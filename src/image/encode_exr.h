// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "deltasplat/image/write_deep_image.h"
#include "deltasplat/image/write_image.h"

namespace deltasplat {

/// The writer behind ExrRows, called after its checks.
class ExrRowsFile {
  public:
    virtual ~ExrRowsFile() = default;
    /// @param rows  the next rows, as wide as the box
    virtual void write(const Image& rows) = 0;
    virtual void finish() = 0;
};

std::string encodeExr(const std::filesystem::path& file, const Image& image,
                      const ImageFileOptions& options);
std::string encodeDeepExr(const std::filesystem::path& file, const DeepImage& image,
                          const ImageFileOptions& options);
std::unique_ptr<ExrRowsFile> openExrRows(const std::filesystem::path& file, glm::ivec2 sizePixels,
                                         const PixelBox& box, const ImageFileOptions& options);

}  // namespace deltasplat
