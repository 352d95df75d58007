// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace deltasplat {

/// What `FILE:NAME` stands for.
struct FileAndName {
    std::filesystem::path file;
    std::string name;  ///< within the file; empty: the file alone was named
};

/// Returns the file that is named, or the part of the text before a colon, of several such files
/// the one with the longest name; empty if there is none of these.
/// @throw Error(kUsage) naming the option, if nothing follows behind the colon
std::optional<FileAndName> findFileAndName(const std::string& option,
                                           const std::filesystem::path& given);

}  // namespace deltasplat
