// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ingest/vdb/vdb_walk.h"

namespace deltasplat {

/// Returns the most bytes that a note of so many leaves may have: packing may add a little.
constexpr std::uint64_t mostLeafSizesBytes(std::size_t leaves) {
    return 64 + 9 * std::uint64_t{leaves};
}

/// Returns how many bytes each leaf of a grid has in its file behind its mask, in file order, if
/// that is noted for as many leaves as there are, and soundly. A note may be wrong.
/// @param stored  value of the grid's metadata "file_delayed_load" as the file has it
std::optional<std::vector<std::uint64_t>> leafSizesOf(const std::string& stored, std::size_t leaves,
                                                      const VdbValueFormat& format);

}  // namespace deltasplat
