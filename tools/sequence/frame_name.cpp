// SPDX-License-Identifier: Apache-2.0
#include "sequence/frame_name.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>

#include "ingest/files/input_files.h"
#include "ingest/files/input_kind.h"

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

// @param stackBegin  where the name of an image stack begins
std::optional<FrameName> FrameName::find(const std::string& text, std::size_t stackBegin) {
    FrameName name;
    for (std::size_t i = 0; i < text.size();) {
        const Found found = placeAt(text, i, i >= stackBegin);
        if (found.digits == 0) {
            name.after_ += text.substr(i, found.length);
        } else {
            name.places_.push_back({std::move(name.after_), found.digits});
            name.after_.clear();
        }
        i += found.length;
    }
    if (name.places_.empty()) return {};
    return name;
}

std::optional<FrameName> FrameName::find(const std::filesystem::path& file) {
    return find(file.string(), std::string::npos);
}

std::optional<FrameName> FrameName::findInput(const std::filesystem::path& input) {
    const std::string text = input.string();
    return find(text, isImageName(input) ? text.size() - input.filename().string().size()
                                         : std::string::npos);
}

std::filesystem::path FrameName::at(int frame) const {
    std::string text;
    for (const Place& place : places_) text += place.before + numberText(frame, place.digits);
    return text + after_;
}

std::filesystem::path FrameName::inputAt(int frame) const {
    std::filesystem::path file = at(frame);
    const auto folder = std::filesystem::path(places_.front().before + "#").parent_path();
    if (file.parent_path() != folder) requireFoundIn(folder, file);
    return file;
}

}  // namespace deltasplat
