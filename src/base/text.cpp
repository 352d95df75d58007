// SPDX-License-Identifier: Apache-2.0
// Based on: The Unicode Standard, version 15, table 3-7, "Well-Formed UTF-8 Byte Sequences", and
// section 23.2, "Layout Controls".
// Based on: V. I. Levenshtein, "Binary codes capable of correcting deletions, insertions, and
// reversals", 1966; the dynamic programme of Wagner and Fischer, 1974, in which neighbours that
// have changed places count once, as in F. J. Damerau, "A technique for computer detection and
// correction of spelling errors", 1964.
#include "base/text.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

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

struct Range {
    std::uint32_t first, last;
};

// What controls a terminal, turns the order of what stands beside it, ends a line or is not seen.
// Joiners (U+200C, U+200D), which words of some scripts need, stay.
constexpr std::array kControls{
    Range{0x0, 0x1f},      Range{0x7f, 0x9f},     Range{0xad, 0xad},     Range{0x61c, 0x61c},
    Range{0x180e, 0x180e}, Range{0x200b, 0x200b}, Range{0x200e, 0x200f}, Range{0x2028, 0x202e},
    Range{0x2060, 0x206f}, Range{0xfeff, 0xfeff}, Range{0xfff9, 0xfffb}, Range{0xe0000, 0xe007f}};

std::uint32_t codeOf(const std::string& text, std::size_t i, std::size_t bytes) {
    const auto byte = [&](std::size_t k) {
        return std::uint32_t(static_cast<unsigned char>(text[i + k]));
    };
    std::uint32_t code = bytes == 1 ? byte(0) : byte(0) & (0x7fU >> bytes);
    for (std::size_t k = 1; k < bytes; ++k) code = code << 6 | (byte(k) & 0x3fU);
    return code;
}

bool controls(const std::string& text, std::size_t i, std::size_t bytes) {
    const std::uint32_t code = codeOf(text, i, bytes);
    return std::any_of(kControls.begin(), kControls.end(), [&](const Range& range) {
        return range.first <= code && code <= range.last;
    });
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

namespace {

std::size_t editDistance(const std::string& a, const std::string& b) {
    using Row = std::vector<std::size_t>;
    Row row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    Row before = row;  // and the one before that
    Row earlier = row;
    for (std::size_t i = 0; i < a.size(); ++i) {
        earlier.swap(before);
        before.swap(row);
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = before[j] + (a[i] == b[j] ? 0 : 1);
            row[j + 1] = std::min({replaced, before[j + 1] + 1, row[j] + 1});
            const bool isSwapped = i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j];
            if (isSwapped) row[j + 1] = std::min(row[j + 1], earlier[j - 1] + 1);
        }
    }
    return row.back();
}

}  // namespace

std::string suggestion(const std::string& text, const std::vector<std::string>& words) {
    // More than a third of the letters wrong is another word, not a slip.
    std::size_t best = text.size() / 3 + 1;
    std::string found;
    for (const std::string& word : words) {
        const std::size_t longer = std::max(text.size(), word.size());
        if (longer - std::min(text.size(), word.size()) >= best) continue;
        const std::size_t distance = editDistance(text, word);
        if (distance >= best) continue;
        best = distance;
        found = word;
    }
    return found.empty() ? "" : " Did you mean '" + found + "'?";
}

namespace {

std::string shortened(const std::string& name) {
    constexpr std::size_t kMost = 120;
    if (name.size() <= kMost) return name;
    std::size_t end = kMost;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;  // in UTF-8
    return name.substr(0, end) + "...";
}

}  // namespace

std::string nameList(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 32;
    // One more is named rather than counted.
    const std::size_t named = names.size() <= kMost + 1 ? names.size() : kMost;
    std::string list;
    for (std::size_t i = 0; i < named; ++i) list += (i == 0 ? "" : ", ") + shortened(names[i]);
    if (named < names.size()) list += " and " + countText(names.size() - named, "other");
    return list;
}

}  // namespace deltasplat
