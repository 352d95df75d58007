// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "deltasplat/progress.h"
#include "files/file_bytes.h"
#include "formats/vdb/vdb_leaves.h"
#include "formats/vdb/vdb_walk.h"
#include "volume/code_nodes.h"
#include "volume/tree_types.h"

namespace deltasplat {

/// Makes the tree that a file has, node by node as OpenVDB does, on all threads.
/// @param type        of its values: a number, bool, mask or vector of three numbers
/// @param background  as it is stored
/// @param nodes       those of the tree that are no leaves
/// @param leaves      all of them, in the order of the file
/// @return null if some are damaged
/// @throw whatever the listener throws
openvdb::tree::TreeBase::Ptr readTree(const FileBytes& file, const std::string& type,
                                      const VdbValueFormat& format,
                                      std::span<const char> background,
                                      const std::vector<VdbNode>& nodes, const VdbLeaves& leaves,
                                      const Listener& listener);

/// Makes a tree of the same nodes whose leaves have no values: LeafNode::transientData() is which
/// of `leaves` each of them is.
/// @tparam T  value type: float, double, std::int32_t or std::int64_t
/// @return null if nodes are damaged
template <typename T>
typename openvdb::tree::Tree4<T, 5, 4, 3>::Type::Ptr readNodes(const FileBytes& file,
                                                               const VdbValueFormat& format,
                                                               T background,
                                                               const std::vector<VdbNode>& nodes,
                                                               const VdbLeaves& leaves);

/// The active tiles of a grid of numbers.
class VdbTiles {
  public:
    const std::vector<TilePlace>& places() const { return places_; }
    /// @tparam T  the grid's value type
    template <typename T>
    std::span<const T> values() const {
        assert(values_.size() == places_.size() * sizeof(T));
        return {reinterpret_cast<const T*>(values_.data()), places_.size()};
    }

    /// Reads and unpacks them, on all threads.
    /// @return nothing if they are damaged
    static std::optional<VdbTiles> read(const FileBytes& file, const VdbValueFormat& format,
                                        const std::vector<VdbNode>& nodes);

  private:
    std::vector<TilePlace> places_;
    std::vector<char> values_;  // halves as floats or doubles
};

}  // namespace deltasplat
