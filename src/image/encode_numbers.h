// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/image/write_image.h"

namespace deltasplat {

/// Returns the numbers of a picture's stored pixels, row by row from the top: its first channel, or
/// ImageFileOptions::nothing where alpha is 0 and that is not 0. What no float holds is the nearest
/// that one does, and NaN 0.
std::vector<float> numbersOf(const Image& image, const ImageFileOptions& options);

/// Returns the bytes of a .npy of shape (height, width), or of a .nrrd or .mha of one slice, whose
/// voxels lie where `options` says.
std::string encodeNumbers(const std::filesystem::path& file, const Image& image,
                          const ImageFileOptions& options);

}  // namespace deltasplat
