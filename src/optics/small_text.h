// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace deltasplat {

/// Reads a whole text file, without the byte order mark of UTF-8 that it may begin with.
/// @param expected  what the file should be, for messages
/// @throw Error(kInput) if it is no file that can be read, or longer than 16 MiB
std::string readSmallText(const std::filesystem::path& file, const std::string& expected);

}  // namespace deltasplat
