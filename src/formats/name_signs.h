// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace deltasplat {

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
