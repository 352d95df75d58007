// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace deltasplat {

/// Returns an input's files, the input first if it is one: a header and its data file, a pattern's
/// images, or a folder's slices. Looks only at names, headers and the first bytes of a folder's
/// files; data files that headers name need not exist. An unreadable input is returned alone: its
/// reader reports the problem.
std::vector<std::filesystem::path> filesOf(const std::filesystem::path& input);

/// From now on readers call requireConfined. Process-wide, like memory limits; not thread-safe.
void confineInputs();
bool inputsAreConfined();

/// Checks that an input's files, links resolved, lie in or below its folder (or the input itself).
/// @throw Error(kInput) "<input>: got <file>, which is outside of <folder>; expected ..."
void requireConfined(const std::filesystem::path& input);

/// If inputs are confined: checks that a folder found by a pattern lies, links resolved, in the
/// pattern's base, the part before its first wildcard folder.
/// @throw Error(kInput)
void requireFoundIn(const std::filesystem::path& folder, const std::filesystem::path& input);

/// If inputs are confined: checks a file that the input names in the same way.
void requireConfined(const std::filesystem::path& input, const std::filesystem::path& named);

/// Returns which of the file's `count` >= 1 volumes to read, counted from 0.
/// @param axes    "dims 64x64x36x120", for messages
/// @param chosen  the requested volume; empty: the only one
/// @throw Error(kInput) if that volume does not exist, or there are several and none is chosen
std::int64_t chooseVolume(const std::string& where, const std::string& axes, std::int64_t count,
                          const std::optional<std::int64_t>& chosen);

// Names may contain signs: numbers (# @ % $), characters (* ? [ ]), or braces for parts of an
// input's name ({ }). A sign is literal after a `\`, and in the name of a folder that exists as
// written.

/// Whether the character at `at` is a backslash that escapes the sign, or backslash, after it.
bool isEscape(std::string_view text, std::size_t at);

/// Whether a text contains a sign or a backslash.
bool hasSigns(std::string_view text);

/// Returns the text with 0 in place of escaped signs and their backslashes.
std::string maskedEscapes(std::string_view text);

/// Returns the text without its escaping backslashes.
std::string withoutEscapes(std::string_view text);

struct NamePart {
    std::string text;        ///< includes the slash that follows
    bool isFolder = false;   ///< a slash follows
    bool isLiteral = false;  ///< a folder that exists as written, although its name has signs
};

/// Returns the parts of a path; concatenated they give the path.
std::vector<NamePart> partsOfName(const std::string& path);

bool isFolderThere(const std::string& path);

/// Returns the file that an output's name means once its escapes are removed.
std::filesystem::path plainName(const std::filesystem::path& file);

/// Does the same for an input. Keeps the name if that or neither form exists, and the backslashes
/// in an image stack's name, which stackPattern reads.
std::filesystem::path plainInput(const std::filesystem::path& input);

}  // namespace deltasplat
