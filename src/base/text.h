// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <glm/fwd.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <string>
#include <vector>

namespace deltasplat {

/// Returns a count and its words, of one or of several: "1 voxel is", "2 voxels are".
inline std::string countText(std::uint64_t count, const std::string& one,
                             const std::string& several) {
    return std::to_string(count) + " " + (count == 1 ? one : several);
}

/// The same for a word whose plural ends with s: "1 page", "2 pages".
inline std::string countText(std::uint64_t count, const std::string& one) {
    return countText(count, one, one + "s");
}

/// Returns lengths along each axis: "512x512", "256x256x128".
template <glm::length_t kAxes, typename T>
std::string dimsText(const glm::vec<kAxes, T>& dims, const char* times = "x") {
    std::string text;
    for (glm::length_t axis = 0; axis < kAxes; ++axis)
        text += (axis == 0 ? "" : times) + std::to_string(dims[axis]);
    return text;
}

/// Returns the text with its ASCII letters in lower case.
inline std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

/// Returns the shortest text that reads back as the same number, whatever the locale.
inline std::string numberText(double number) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

/// Returns "x,y", as options are written.
inline std::string numberText(const glm::dvec2& v) {
    return numberText(v.x) + "," + numberText(v.y);
}

/// Returns "x,y,z", as options are written.
inline std::string numberText(const glm::dvec3& v) {
    return numberText(glm::dvec2(v)) + "," + numberText(v.z);
}

/// Returns foreign text fit for a message of one line of UTF-8. Characters that control a terminal
/// or the order of text, or that nobody sees, become "?"; so does each byte that is no UTF-8.
std::string printable(const std::string& text);

/// Returns " Did you mean 'word'?" for the word most like `text`, the first of several. Returns
/// nothing where no word is near enough for a slip of the finger.
std::string suggestion(const std::string& text, const std::vector<std::string>& words);

/// Returns a suggestion behind a sentence that has no full stop yet.
inline std::string afterStop(const std::string& suggestion) {
    return suggestion.empty() ? "" : "." + suggestion;
}

/// Returns "a, b, c" for a readable line: of many names the first few, and the number of the
/// others.
std::string nameList(const std::vector<std::string>& names);

/// Returns the name of an enumerator; of what is none, the first one's.
/// @param names  in the order of the enumerators, which count from 0 on
template <typename Enum>
std::string enumName(Enum value, std::initializer_list<const char*> names) {
    const auto place = static_cast<std::size_t>(value);
    return names.begin()[place < names.size() ? place : 0];
}

}  // namespace deltasplat
