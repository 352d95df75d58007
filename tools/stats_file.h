// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace deltasplat {

/// Returns whether two names are of one file, which need not exist.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// Checks the name given to --stats (empty: none) before the work: that the file can be written,
/// and would not overwrite one of `others`, which are called `names` in the message.
/// @throw Error(kUsage), Error(kOutput)
void checkStatsFile(const std::filesystem::path& stats,
                    const std::vector<std::filesystem::path>& others, const std::string& names);

}  // namespace deltasplat
