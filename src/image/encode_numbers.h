// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/image/write_image.h"

namespace deltasplat {

/// Returns the first channel of a picture's stored pixels, row by row from the top, as finite
/// floats with NaN as 0. Where alpha is 0, ImageFileOptions::nothing unless that is 0.
std::vector<float> numbersOf(const Image& image, const ImageFileOptions& options);

/// Returns a .npy of shape (height, width), or a one-slice .nrrd or .mha placed by `options`.
std::string encodeNumbers(const std::filesystem::path& file, const Image& image,
                          const ImageFileOptions& options);

}  // namespace deltasplat
