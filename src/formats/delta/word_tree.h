// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/uncleared.h"
#include "formats/vdb/vdb_leaves.h"
#include "volume/tree_types.h"

namespace deltasplat {

/// Returns the origin of the leaf of words from 512 * `leaf` on: nodes fill up in OpenVDB's order.
openvdb::Coord wordLeafOrigin(std::size_t leaf);

/// Returns a tree whose active voxels are consecutive words.
openvdb::Int64Tree::Ptr treeOfWords(const std::vector<std::uint64_t>& words);

/// Returns the words of such a tree, followed by `padding` zeros.
/// @throw Error(kInput) for a gap between words; Error(kFailed) if memory is too small
std::vector<std::uint64_t> wordsOfTree(const openvdb::Int64Tree& tree, std::size_t padding,
                                       const std::string& where);

/// Returns the number of words in a file's leaves of int64; nothing if these are no tree of words.
std::optional<std::size_t> countWords(const VdbLeaves& leaves);
/// Returns the first `count` words of such leaves, followed by `padding` zeros. Multi-threaded.
/// @return nothing for a gap between words
/// @throw Error(kFailed) if memory is too small
std::optional<UnclearedVector<std::uint64_t>> wordsOfLeaves(const VdbLeaves& leaves,
                                                            std::size_t count, std::size_t padding,
                                                            const std::string& where);

}  // namespace deltasplat
