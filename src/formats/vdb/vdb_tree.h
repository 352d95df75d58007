// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "deltasplat/progress.h"
#include "files/file_bytes.h"
#include "formats/vdb/vdb_leaves.h"
#include "formats/vdb/vdb_walk.h"
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

}  // namespace deltasplat
