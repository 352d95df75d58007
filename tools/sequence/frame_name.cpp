// SPDX-License-Identifier: Apache-2.0
#include "sequence/frame_name.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <system_error>
#include <utility>

#include "formats/images/image_stack.h"
#include "formats/input_files.h"
#include "formats/input_kind.h"

namespace deltasplat {
namespace {

// A name is no longer than this.
constexpr int kMostDigits = 32;

struct Found {
    std::size_t length;
    int digits;  // 0: these characters are no place
};

constexpr Found kNone{1, 0};

bool isDigit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

Found runOf(const std::string& text, std::size_t at, char c) {
    const std::size_t end = std::min(text.find_first_not_of(c, at), text.size());
    const std::size_t length = end - at;
    return {length, length > kMostDigits ? 0 : int(length)};
}

// Digits from `at` on, as a number; `end` is set behind them.
int digitsAt(const std::string& text, std::size_t at, std::size_t& end) {
    int number = 0;
    for (end = at; end < text.size() && isDigit(text[end]) && number <= kMostDigits; ++end)
        number = 10 * number + (text[end] - '0');
    return number;
}

// %d or %0Nd.
Found percentAt(const std::string& text, std::size_t at) {
    std::size_t end = at;
    const int digits = digitsAt(text, at + 1, end);
    const bool isFilled = end == at + 1 || text[at + 1] == '0';
    if (!isFilled || digits > kMostDigits || end >= text.size() || text[end] != 'd') return kNone;
    return {end + 1 - at, std::max(digits, 1)};
}

// $F or $FN, but no other variable.
Found variableAt(const std::string& text, std::size_t at) {
    if (text.compare(at, 2, "$F") != 0) return kNone;
    std::size_t end = at;
    const int digits = digitsAt(text, at + 2, end);
    if (digits > kMostDigits) return kNone;
    if (end == at + 2 && end < text.size() &&
        (std::isalpha(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_'))
        return kNone;
    return {end - at, std::max(digits, 1)};
}

Found placeAt(const std::string& text, std::size_t at, bool isOfStack) {
    switch (text[at]) {
        case '@':
            return runOf(text, at, '@');
        case '$':
            return variableAt(text, at);
        case '#':
            return isOfStack ? kNone : runOf(text, at, '#');
        case '%':
            return isOfStack ? kNone : percentAt(text, at);
        default:
            return kNone;
    }
}

std::string numberText(int frame, int digits) {
    std::array<char, kMostDigits + 16> text;
    std::snprintf(text.data(), text.size(), "%0*d", digits, frame);
    return text.data();
}

}  // namespace

std::string FrameName::Part::at(int frame) const {
    std::string filled;
    for (const Place& place : places) filled += place.before + numberText(frame, place.digits);
    return filled + after;
}

// @param isOfStack  whether it is the name of an image stack, which keeps its backslashes
FrameName::Part FrameName::parse(const std::string& text, bool isOfStack) {
    Part part;
    part.text = text;
    for (std::size_t i = 0; i < text.size();) {
        if (isEscape(text, i)) {
            part.after += text.substr(isOfStack ? i : i + 1, isOfStack ? 2 : 1);
            i += 2;
            continue;
        }
        const Found found = placeAt(text, i, isOfStack);
        if (found.digits == 0) {
            part.after += text.substr(i, found.length);
        } else {
            part.places.push_back({std::exchange(part.after, {}), found.digits});
        }
        i += found.length;
    }
    return part;
}

std::optional<FrameName> FrameName::find(const std::string& text, bool isStack) {
    FrameName name;
    name.isStack_ = isStack;
    std::string before;
    bool hasPlaces = false;
    for (const NamePart& named : partsOfName(text)) {
        Part part{named.text, named.isFolder, {}, named.text};
        if (!named.isLiteral) part = parse(named.text, isStack && !named.isFolder);
        part.isFolder = named.isFolder;
        before += named.text;
        const bool isFirst = named.isFolder && !part.places.empty() && name.folder_.empty();
        if (isFirst) name.folder_ = before.substr(0, before.size() - 1);
        hasPlaces = hasPlaces || !part.places.empty();
        name.parts_.push_back(std::move(part));
    }
    if (!hasPlaces) return {};
    return name;
}

std::optional<FrameName> FrameName::find(const std::filesystem::path& file) {
    return find(file.string(), false);
}

std::optional<FrameName> FrameName::findInput(const std::filesystem::path& input) {
    const std::string text = input.string();
    std::error_code ignored;
    if (!hasSigns(text) || std::filesystem::exists(input, ignored)) return {};
    return find(text, isImageName(input));
}

std::filesystem::path FrameName::at(int frame) const {
    std::string text;
    bool moves = false;
    for (const Part& part : parts_) {
        // In a folder of this frame there may be one of that very name.
        const bool isLiteral =
            moves && part.isFolder && !part.places.empty() && isFolderThere(text + part.text);
        std::string filled = isLiteral ? part.text : part.at(frame);
        if (!part.isFolder && isStack_ && !stackPattern(filled)) filled = withoutEscapes(filled);
        text += filled;
        moves = moves || !part.places.empty();
    }
    return text;
}

std::filesystem::path FrameName::inputAt(int frame) const {
    std::filesystem::path file = at(frame);
    std::string fixed;  // before the first place
    for (std::size_t i = 0; parts_[i].places.empty(); ++i) fixed += parts_[i].after;
    const auto folder = std::filesystem::path(fixed + "#").parent_path();
    if (file.parent_path() != folder) requireFoundIn(folder, file);
    return file;
}

}  // namespace deltasplat
