// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace deltasplat {

/// Returns every file that an input consists of, itself first if it is a file: a header and its
/// data file, the images that a pattern stands for, or the slices in a folder. Only names, headers
/// and the first bytes of a folder's files are looked at; a data file that a header names need not
/// exist. Of an input that cannot be read, it returns the input alone: what is wrong is for its
/// reader to say.
std::vector<std::filesystem::path> filesOf(const std::filesystem::path& input);

/// From now on readers refuse inputs that are not confined as requireConfined says. For a whole
/// program, as memory limits are; not thread-safe.
void confineInputs();
bool inputsAreConfined();

/// Checks that all files of an input, links followed, lie in its folder, or in the folder that it
/// is, or below.
/// @throw Error(kInput) "<input>: got <file>, which is outside of <folder>; expected ..."
void requireConfined(const std::filesystem::path& input);

/// Checks, where inputs are confined at all, that the folder of an input that a pattern stands for
/// lies, links followed, in the pattern's own: the one before the first folder of any name.
/// @throw Error(kInput)
void requireFoundIn(const std::filesystem::path& folder, const std::filesystem::path& input);

/// The same of a file that an input names, where inputs are confined at all.
void requireConfined(const std::filesystem::path& input, const std::filesystem::path& named);

/// Returns which of the `count` >= 1 volumes of a file is to be read, from 0 on.
/// @param axes    "dims 64x64x36x120", for messages
/// @param chosen  what was asked for; empty: the only one
/// @throw Error(kInput) if there is no such volume, or several and none is chosen
std::int64_t chooseVolume(const std::string& where, const std::string& axes, std::int64_t count,
                          const std::optional<std::int64_t>& chosen);

// Signs in names that may stand for something else: numbers (# @ % $), characters (* ? [ ]), parts
// of an input's name ({ }). Each stands for itself behind a `\`, and in the name of a folder that
// is there as it is written.

/// Whether a backslash at a place makes the sign behind it, or another backslash, stand for itself.
bool isEscape(std::string_view text, std::size_t at);

/// Whether any sign, or a backslash before one, is in a text.
bool hasSigns(std::string_view text);

/// Returns a text with 0 in place of signs that stand for themselves, and of their backslashes.
std::string maskedEscapes(std::string_view text);

/// Returns a text without the backslashes before signs.
std::string withoutEscapes(std::string_view text);

/// What stands between slashes of a path.
struct NamePart {
    std::string text;        ///< with the slash behind it
    bool isFolder = false;   ///< whether there is one
    bool isLiteral = false;  ///< a folder that is there as it is written, though its name has signs
};

/// Returns the parts of a path, which are the path if they are put together.
std::vector<NamePart> partsOfName(const std::string& path);

/// Whether a folder is there.
bool isFolderThere(const std::string& path);

/// Returns the file that a name of an output means if its signs stand for nothing else.
std::filesystem::path plainName(const std::filesystem::path& file);

/// The same of an input, which is the file or folder of the very name that was given if there is
/// one, or if there is neither. In the name of an image stack, backslashes stay for who looks for
/// its files.
std::filesystem::path plainInput(const std::filesystem::path& input);

}  // namespace deltasplat
