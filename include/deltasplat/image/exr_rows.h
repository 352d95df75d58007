// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "deltasplat/image/write_image.h"

namespace deltasplat {

/// Writes an .exr some rows at a time: the file that writeImage makes of the whole picture, without
/// ever having all of it. The file appears under its final name only when it is whole.
class ExrRows {
  public:
    /// @param sizePixels  of the whole picture
    /// @param box         what is stored of it: ImageFileOptions::region, or what is known to be
    ///                    seen of it; ExrOptions::autocrop itself changes nothing here
    /// @throw Error(kUsage) as writeImage, or for `channels` besides; Error(kOutput) if it cannot
    /// be
    ///        written, or is no file but a device
    ExrRows(const std::filesystem::path& file, glm::ivec2 sizePixels, const PixelBox& box,
            const ImageFileOptions& options);
    ~ExrRows();
    ExrRows(const ExrRows&) = delete;
    ExrRows& operator=(const ExrRows&) = delete;

    /// Writes the next rows.
    /// @param rows  of the box's width
    /// @throw Error(kUsage) if they are of another, or too many; Error(kOutput)
    void write(const Image& rows);
    /// Ends the file, after its last row.
    /// @throw Error(kUsage) if rows are missing; Error(kOutput)
    void finish();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
