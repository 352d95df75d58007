// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "deltasplat/progress.h"

namespace deltasplat {

/// Whether a name is a pattern: has `*`, `?` or `[...]`, and is not that of a file or folder; those
/// of folders that are there as they are written do not count.
bool isPattern(const std::filesystem::path& name);

/// Whether a name without folders fits: `*` stands for any characters, `?` for one (of UTF-8),
/// `[a-z]` for one of these and `[!a-z]` for one of no others, and what follows a `\` for itself.
bool fitsPattern(std::string_view name, std::string_view pattern);

/// A file that a pattern has found.
struct FoundFile {
    std::filesystem::path file;
    std::filesystem::path folder;  ///< relative to the last folder before the first `*`, `?` or `[`
};

/// What a pattern has found, in an order in which numbers in names count as numbers.
struct FoundFiles {
    std::filesystem::path base;  ///< the last folder before the first `*`, `?` or `[`; may be empty
    std::vector<FoundFile> files;
    /// Folders that may hold more, which cannot be read, each with what the system says.
    std::vector<std::pair<std::filesystem::path, std::string>> unread;
};

/// Finds all files that fit. What is there by the very name that stands between slashes is meant
/// by it alone. Otherwise `**` stands for any folders, or none; a pattern that ends with a
/// slash finds folders. Nothing is found by `*`, `?` or `[...]` whose name begins with a dot,
/// unless the pattern does so as well there, and no temporary file of this program's, nor what is
/// neither file nor folder. `**` does not follow links.
/// @param listener  told that work goes on, for each folder
FoundFiles findFiles(const std::filesystem::path& pattern, const Listener& listener);

}  // namespace deltasplat
