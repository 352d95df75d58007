// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace deltasplat {

/// Checks before the work that neither a conversion's output, with its data file, nor its --stats
/// file (empty: none) would overwrite a file that the input consists of, or the other; the output
/// may take the place of the input itself, which is read by then.
/// @return the files of the input
/// @throw Error(kUsage), and Error(kOutput) if the --stats file cannot be written
std::vector<std::filesystem::path> checkConversionFiles(const std::filesystem::path& input,
                                                        const std::filesystem::path& output,
                                                        const std::filesystem::path& stats);

}  // namespace deltasplat
