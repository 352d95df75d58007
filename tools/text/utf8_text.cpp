// SPDX-License-Identifier: Apache-2.0
#include "text/utf8_text.h"

namespace deltasplat {
namespace {

// How many bytes a sequence has by its first one; 0 for a byte that begins none.
int sequenceLength(unsigned char first) {
    if (first < 0x80) return 1;
    if (first >= 0xC2 && first < 0xE0) return 2;
    if (first >= 0xE0 && first < 0xF0) return 3;
    return first >= 0xF0 && first < 0xF5 ? 4 : 0;
}

// Whether a code point written in so many bytes is one that text may hold, written the short way.
bool isText(char32_t point, int length) {
    constexpr char32_t kSmallest[] = {0, 0x20, 0xA0, 0x800, 0x10000};
    const bool surrogate = point >= 0xD800 && point < 0xE000;
    const bool noCharacter = point == 0x7F || (point & 0xFFFE) == 0xFFFE;
    return point >= kSmallest[length] && point < 0x110000 && !surrogate && !noCharacter;
}

}  // namespace

std::u32string codePoints(std::string_view text) {
    std::u32string points;
    while (!text.empty()) {
        const auto first = static_cast<unsigned char>(text[0]);
        const int length = sequenceLength(first);
        bool whole = length > 0 && text.size() >= std::size_t(length);
        char32_t point = length == 1 ? first : first & (0x7F >> length);
        for (int i = 1; whole && i < length; ++i) {
            const auto next = static_cast<unsigned char>(text[i]);
            whole = (next & 0xC0) == 0x80;
            point = point << 6 | (next & 0x3F);
        }
        const bool good = whole && isText(point, length);
        points += good ? point : U'?';
        text.remove_prefix(good ? length : 1);
    }
    return points;
}

std::string utf8(std::u32string_view points) {
    std::string text;
    for (const char32_t point : points) {
        const int more = point < 0x80 ? 0 : point < 0x800 ? 1 : point < 0x10000 ? 2 : 3;
        constexpr unsigned kFirst[] = {0, 0xC0, 0xE0, 0xF0};
        text += char(kFirst[more] | unsigned(point >> (6 * more)));
        for (int i = more - 1; i >= 0; --i)
            text += char(0x80 | (unsigned(point >> (6 * i)) & 0x3F));
    }
    return text;
}

std::string markupText(std::string_view text) {
    std::u32string result;
    for (const char32_t point : codePoints(text)) {
        switch (point) {
            case U'&':
                result += U"&amp;";
                break;
            case U'<':
                result += U"&lt;";
                break;
            case U'>':
                result += U"&gt;";
                break;
            default:
                result += point;
        }
    }
    return utf8(result);
}

}  // namespace deltasplat
