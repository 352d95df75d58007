// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "deltasplat/image/image.h"

namespace deltasplat {

/// Returns a small copy of a picture that was written: of a whole number of its pixels each way the
/// mean, of its display window, as light. Read some rows at a time.
/// @param mostSide  pixels that its longer side has at most
/// @return an image without pixels if the file is deep, or cannot be read
Image readThumbnail(const std::filesystem::path& file, int mostSide);

/// Returns a picture over black as a .jpg of little size.
/// @throw Error(kOutput) if it cannot be encoded
std::string encodeThumbnail(const Image& image);

/// Whether a file is an image of which all pixels can be read: not cut short by a copy that broke
/// off, and not another kind of file.
bool isWholeImage(const std::filesystem::path& file);

}  // namespace deltasplat
