// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "deltasplat/error.h"

namespace deltasplat {

/// @throw Error(kInput) "<file>: got ...; expected ..."
[[noreturn]] inline void refuseFile(const std::filesystem::path& file, const std::string& got,
                                    const std::string& expected) {
    throw Error(ErrorCode::kInput, file.string(), got, expected);
}

/// Returns the file's extension in lower case, a ".gz" before it kept: ".raw", ".raw.gz", ".vdb".
std::string lowerExtension(const std::filesystem::path& file);

/// Whether a file is named as .vdb files are, under gzip or not.
bool isVdbName(const std::filesystem::path& file);

/// Returns the file's name without folder and without the extension that lowerExtension gives.
std::string nameWithoutExtensions(const std::filesystem::path& file);

/// Returns the name of a folder, whether or not its path ends with a slash.
std::string folderName(const std::filesystem::path& folder);

/// @throw Error(kInput) unless `file` exists and is a regular file
void requireRegularFile(const std::filesystem::path& file);

/// Returns the hash FNV-1a (Fowler, Noll, Vo) of a text.
std::uint64_t hashOf(std::string_view text, std::uint64_t before = 0xcbf29ce484222325);

/// Returns a hash of a file's size, its first bytes and its last ones, which does not depend on its
/// name; 0 where there is no readable file.
std::uint64_t markOf(const std::filesystem::path& file);

}  // namespace deltasplat
