// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/tree/Tree.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

struct CodeLeaf;
class SlotBlocks;

/// The codes of a volume: in OpenVDB's standard layout (leaves of 8x8x8 voxels, x slowest, z
/// fastest), where a uniform active 8x8x8 block may be an active tile at any level, so that a large
/// constant region costs no memory; or as blocks that lie along a slice axis, of which the tree is
/// made when it is first asked for.
struct CodeTree {
    using Tree = openvdb::tree::Tree4<Code, 5, 4, 3>::Type;
    using Leaf = Tree::LeafNodeType;

    CodeTree() = default;
    /// Copies the tree alone.
    CodeTree(const CodeTree& other) : tree_(other.tree()) {}
    /// Makes the tree in place: OpenVDB's trees cannot be moved.
    template <typename... Args>
    explicit CodeTree(std::in_place_t, Args&&... args) : tree_(std::forward<Args>(args)...) {}
    explicit CodeTree(std::shared_ptr<const SlotBlocks> blocks);

    /// To be filled, before anybody asks for leaves(); not of one made of blocks.
    Tree& tree() { return tree_; }
    /// Thread-safe. Of one made of blocks the first call makes the tree.
    /// @throw Error(kFailed) if these are some slices of a volume only
    const Tree& tree() const;
    /// The blocks that this is made of, if they lie along an axis; else null.
    const SlotBlocks* blocksAlong(int sliceAxis) const;
    /// Returns how much memory codes take, without making anything.
    std::uint64_t memoryBytes() const;

    /// Lists the leaves that have active voxels, with the ranges of their codes: made on the first
    /// call, after which the tree must not change. Thread-safe.
    std::shared_ptr<const std::vector<CodeLeaf>> leaves() const;
    /// Tells leaves() what it would find out, for who has filled the tree: it must not change then.
    /// @param leaves  all that have active voxels, in any order
    void noteLeaves(std::vector<CodeLeaf> leaves);

  private:
    mutable Tree tree_{Code{0}};
    std::shared_ptr<const SlotBlocks> blocks_;  // null: the tree is all that there is
    mutable std::mutex mutex_;
    mutable std::atomic<bool> hasTree_ = false;  // if there are blocks
    mutable std::atomic<std::shared_ptr<const std::vector<CodeLeaf>>> leaves_;
};

/// A leaf of a code tree that has active voxels, and the range of their codes: those which a
/// transfer function makes clear are passed over without being read.
struct CodeLeaf {
    const CodeTree::Leaf* leaf;
    openvdb::Coord origin;  // of the leaf, which is then not looked at
    Code lowest;
    Code highest;
};

/// @param leaf  one that has active voxels
CodeLeaf describeLeaf(const CodeTree::Leaf& leaf);
/// @param codes  of its active voxels, in any order
CodeLeaf describeLeaf(const CodeTree::Leaf& leaf, std::span<const Code> codes);

}  // namespace deltasplat
