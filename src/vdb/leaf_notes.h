// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace deltasplat {

/// Returns the value of a grid's metadata "file_delayed_load" as a file has it, which leafSizesOf
/// reads.
/// @param kinds    of leaves in the order of the file, as PackedLeaves has them
/// @param sizes    likewise
/// @param mayPack  whether they are packed by Blosc where that makes them smaller
std::string leafNotes(const std::vector<std::int8_t>& kinds, const std::vector<std::int64_t>& sizes,
                      bool mayPack);

}  // namespace deltasplat
