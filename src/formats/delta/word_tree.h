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

/// Returns the place in a tree of words of the leaf that has the words from 512 * `leaf` on: nodes
/// are filled one behind the other, in OpenVDB's own order.
openvdb::Coord wordLeafOrigin(std::size_t leaf);

/// Returns a tree whose active voxels are words, one behind the other.
openvdb::Int64Tree::Ptr treeOfWords(const std::vector<std::uint64_t>& words);

/// Returns the words of such a tree, with `padding` zeros behind them.
/// @throw Error(kInput) if there is a gap between them; Error(kFailed) if memory does not hold them
std::vector<std::uint64_t> wordsOfTree(const openvdb::Int64Tree& tree, std::size_t padding,
                                       const std::string& where);

/// Returns how many words a file's leaves of int64 have; nothing if these are no tree of words.
std::optional<std::size_t> countWords(const VdbLeaves& leaves);
/// Returns the first `count` words of such leaves, with `padding` zeros behind them.
/// Multi-threaded.
/// @return nothing if there is a gap between them
/// @throw Error(kFailed) if memory does not hold them
std::optional<UnclearedVector<std::uint64_t>> wordsOfLeaves(const VdbLeaves& leaves,
                                                            std::size_t count, std::size_t padding,
                                                            const std::string& where);

}  // namespace deltasplat
