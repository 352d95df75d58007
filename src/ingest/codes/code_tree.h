// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/tree/Tree.h>

#include <atomic>
#include <memory>
#include <utility>
#include <vector>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

struct CodeLeaf;

/// Codes in OpenVDB's standard layout (leaves of 8x8x8 voxels, x slowest, z fastest). A uniform
/// active 8x8x8 block may be an active tile at any level, so a large constant region costs no
/// memory.
struct CodeTree {
    using Tree = openvdb::tree::Tree4<Code, 5, 4, 3>::Type;
    using Leaf = Tree::LeafNodeType;

    CodeTree() = default;
    CodeTree(const CodeTree& other) : tree(other.tree) {}
    /// Makes the tree in place: OpenVDB's trees cannot be moved.
    template <typename... Args>
    explicit CodeTree(std::in_place_t, Args&&... args) : tree(std::forward<Args>(args)...) {}

    Tree tree{Code{0}};

    /// Lists the leaves that have active voxels, with the ranges of their codes: made on the first
    /// call, after which the tree must not change. Thread-safe.
    std::shared_ptr<const std::vector<CodeLeaf>> leaves() const;

  private:
    mutable std::atomic<std::shared_ptr<const std::vector<CodeLeaf>>> leaves_;
};

/// A leaf of a code tree that has active voxels, and the range of their codes: those which a
/// transfer function makes clear are passed over without being read.
struct CodeLeaf {
    const CodeTree::Leaf* leaf;
    Code lowest;
    Code highest;
};

/// @param leaf  one that has active voxels
CodeLeaf describeLeaf(const CodeTree::Leaf& leaf);

}  // namespace deltasplat
