// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "deltasplat/image/write_image.h"

namespace deltasplat {

/// Writes an .exr some rows at a time: the file that writeImage makes, without holding the whole
/// picture. The file appears under its final name only when it is whole.
class ExrRows {
  public:
    /// @param sizePixels  of the whole picture
    /// @param box         the stored part: ImageFileOptions::region, or the part known to be
    ///                    visible; ExrOptions::autocrop has no effect here
    /// @throw Error(kUsage) as writeImage, or for `channels`; Error(kOutput), also for a device
    ExrRows(const std::filesystem::path& file, glm::ivec2 sizePixels, const PixelBox& box,
            const ImageFileOptions& options);
    ~ExrRows();
    ExrRows(const ExrRows&) = delete;
    ExrRows& operator=(const ExrRows&) = delete;

    /// @param rows  of the box's width
    /// @throw Error(kUsage) for another width or too many rows; Error(kOutput)
    void write(const Image& rows);
    /// @throw Error(kUsage) if rows are missing; Error(kOutput)
    void finish();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
