// SPDX-License-Identifier: Apache-2.0
// Based on: The Unicode Standard, version 15, table 3-7, "Well-Formed UTF-8 Byte Sequences".
#include "printable.h"

namespace deltasplat {
namespace {

// The bytes of the character that begins at `i`, or 0 if none does.
std::size_t characterBytes(const std::string& text, std::size_t i) {
    const auto byte = [&](std::size_t k) {
        return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0u;
    };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    const std::size_t count = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    if (count == 0 || first > 0xf4) return 0;
    // Nothing in more bytes than it needs, no surrogates, nothing beyond U+10FFFF.
    const unsigned least = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
    const unsigned most = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
    if (byte(1) < least || byte(1) > most) return 0;
    for (std::size_t k = 2; k < count; ++k) {
        if (byte(k) < 0x80 || byte(k) > 0xbf) return 0;
    }
    return count;
}

// U+0000 to U+001F and U+007F to U+009F.
bool controls(const std::string& text, std::size_t i, std::size_t bytes) {
    const unsigned first = static_cast<unsigned char>(text[i]);
    if (bytes == 1) return first < ' ' || first == 0x7f;
    return first == 0xc2 && static_cast<unsigned char>(text[i + 1]) < 0xa0;
}

}  // namespace

std::string printable(const std::string& text) {
    std::string shown;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t bytes = characterBytes(text, i);
        if (bytes == 0 || controls(text, i, bytes)) {
            shown += '?';
        } else {
            shown.append(text, i, bytes);
        }
        i += bytes == 0 ? 1 : bytes;
    }
    return shown;
}

}  // namespace deltasplat
