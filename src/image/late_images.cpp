// SPDX-License-Identifier: Apache-2.0
// Functions that a module does, and nothing besides.
#include "deltasplat/hold_out.h"
#include "image/thumbnail.h"
#include "modules/image_module.h"

namespace deltasplat {

bool isWholeImage(const std::filesystem::path& file) {
    return imageModule().isWholeImage(file);
}

Image readThumbnail(const std::filesystem::path& file, int mostSide) {
    return imageModule().readThumbnail(file, mostSide);
}

std::string encodeThumbnail(const Image& image) {
    return imageModule().encodeThumbnail(image);
}

DepthImage readDepthImage(const std::filesystem::path& file, const Listener& listener) {
    return imageModule().readDepthImage(file, listener);
}

}  // namespace deltasplat
