// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

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

}  // namespace deltasplat
