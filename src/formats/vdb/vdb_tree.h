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

/// Makes the tree of a grid on all threads, with the same nodes as OpenVDB.
/// @param type        value type: a number, bool, mask or vector of three numbers
/// @param background  as stored
/// @param nodes       all nodes above the leaves
/// @param leaves      all leaves in file order
/// @return null for damaged nodes or leaves
/// @throw whatever the listener throws
openvdb::tree::TreeBase::Ptr readTree(const FileBytes& file, const std::string& type,
                                      const VdbValueFormat& format,
                                      std::span<const char> background,
                                      const std::vector<VdbNode>& nodes, const VdbLeaves& leaves,
                                      const Listener& listener);

/// Makes the same tree without leaf values: LeafNode::transientData() is the index in `leaves`.
/// @tparam T  value type: float, double, std::int32_t or std::int64_t
/// @return null for damaged nodes
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
    template <typename T>
    std::span<const T> values() const {
        assert(values_.size() == places_.size() * sizeof(T));
        return {reinterpret_cast<const T*>(values_.data()), places_.size()};
    }

    /// Reads and unpacks the tiles on all threads; returns nothing if they are damaged.
    static std::optional<VdbTiles> read(const FileBytes& file, const VdbValueFormat& format,
                                        const std::vector<VdbNode>& nodes);

  private:
    std::vector<TilePlace> places_;
    std::vector<char> values_;  // halves as floats or doubles
};

}  // namespace deltasplat
