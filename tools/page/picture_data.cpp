// SPDX-License-Identifier: Apache-2.0
#include "page/picture_data.h"

#include <algorithm>
#include <cstdint>

#include "deltasplat/image/write_image.h"

namespace deltasplat {

std::string base64Text(std::string_view bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? std::uint8_t(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::string pngDataUri(const Image& image) {
    return "data:image/png;base64," + base64Text(encodeImage("picture.png", image, {}));
}

}  // namespace deltasplat
