// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/error.h"
#include "deltasplat/image/image.h"
#include "deltasplat/image/pixel_box.h"
#include "dims_text.h"

namespace deltasplat {

/// @throw Error(kUsage) unless an image has the size of a part of a picture of `size`
inline void requirePart(const PixelBox& part, glm::ivec2 size, const Image& image) {
    const auto text = [](const PixelBox& box) {
        return dimsText(box.size()) + " pixels from " + std::to_string(box.min.x) + "," +
               std::to_string(box.min.y) + " on";
    };
    const bool isWithin = !part.empty() && part.min.x >= 0 && part.min.y >= 0 &&
                          part.max.x <= size.x && part.max.y <= size.y;
    if (!isWithin) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("part of a picture", text(part), "some of its " + dimsText(size)));
    }
    if (image.size == part.size() &&
        image.rgba.size() == std::size_t{4} * std::size_t(image.size.x) * std::size_t(image.size.y))
        return;
    throw Error(ErrorCode::kUsage, gotExpected("image", dimsText(image.size) + " pixels",
                                               dimsText(part.size()) + ", those of the part"));
}

}  // namespace deltasplat
