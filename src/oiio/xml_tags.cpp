// SPDX-License-Identifier: Apache-2.0
// Based on: Extensible Markup Language 1.0 (W3C, fifth edition), sections 2.5 to 3.1 and 4.6.
#include "oiio/xml_tags.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <utility>

namespace deltasplat {
namespace {

constexpr std::string_view kSpace = " \t\r\n";

std::string utf8Of(std::uint32_t code) {
    if (code < 0x80) return {char(code)};
    if (code < 0x800) return {char(0xc0 | code >> 6), char(0x80 | (code & 0x3f))};
    if (code < 0x10000) {
        return {char(0xe0 | code >> 12), char(0x80 | (code >> 6 & 0x3f)),
                char(0x80 | (code & 0x3f))};
    }
    return {char(0xf0 | (code >> 18 & 7)), char(0x80 | (code >> 12 & 0x3f)),
            char(0x80 | (code >> 6 & 0x3f)), char(0x80 | (code & 0x3f))};
}

// What stands between & and ;, or nothing for what is none of XML's.
std::optional<std::string> characterNamed(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, const char*>, 5> kNames{
        {{"lt", "<"}, {"gt", ">"}, {"amp", "&"}, {"quot", "\""}, {"apos", "'"}}};
    for (const auto& [known, text] : kNames)
        if (name == known) return text;
    if (name.size() < 2 || name[0] != '#') return {};
    const bool isHex = name[1] == 'x';
    std::uint32_t code = 0;
    const char* const end = name.data() + name.size();
    const auto result = std::from_chars(name.data() + (isHex ? 2 : 1), end, code, isHex ? 16 : 10);
    if (result.ec != std::errc{} || result.ptr != end || code > 0x10ffff) return {};
    return utf8Of(code);
}

std::string plainText(std::string_view text) {
    constexpr std::size_t kLongest = 12;  // of what stands between & and ;, both included
    std::string plain;
    while (!text.empty()) {
        const std::size_t end =
            text[0] == '&' ? text.substr(0, kLongest).find(';') : std::string_view::npos;
        const auto character = end == std::string_view::npos
                                   ? std::optional<std::string>()
                                   : characterNamed(text.substr(1, end - 1));
        plain += character.value_or(std::string(1, text[0]));
        text.remove_prefix(character ? end + 1 : 1);
    }
    return plain;
}

std::string_view withoutPrefix(std::string_view name) {
    return name.substr(name.find(':') + 1);
}

}  // namespace

std::string_view XmlTags::takeUntil(std::string_view characters) {
    const std::string_view taken = text_.substr(0, text_.find_first_of(characters));
    text_.remove_prefix(taken.size());
    return taken;
}

void XmlTags::skipSpace() {
    text_.remove_prefix(std::min(text_.find_first_not_of(kSpace), text_.size()));
}

std::optional<XmlTag> XmlTags::next() {
    while (true) {
        takeUntil("<");
        if (text_.starts_with("<!--")) {
            text_.remove_prefix(std::min(text_.find("-->", 4), text_.size()));
            continue;
        }
        if (text_.size() < 2) return {};
        text_.remove_prefix(1);
        if (text_[0] != '!' && text_[0] != '?' && text_[0] != '/') break;
    }
    XmlTag tag;
    tag.name = withoutPrefix(takeUntil(" \t\r\n/>"));
    while (true) {
        skipSpace();
        if (text_.empty()) return {};
        if (text_[0] == '/' || text_[0] == '>') return tag;
        const std::string_view name = takeUntil(" \t\r\n=/>");
        skipSpace();
        if (name.empty() || text_.size() < 2 || text_[0] != '=') return {};
        text_.remove_prefix(1);
        skipSpace();
        if (text_.empty() || (text_[0] != '"' && text_[0] != '\'')) return {};
        const std::string_view quote = text_.substr(0, 1);
        text_.remove_prefix(1);
        tag.attributes[std::string(withoutPrefix(name))] = plainText(takeUntil(quote));
        if (text_.empty()) return {};
        text_.remove_prefix(1);
    }
}

}  // namespace deltasplat
