// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/tree/Tree.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "deltasplat/ingest/volume.h"

// Code for the tree's nodes is generated once, in code_tree.cpp, because it takes longer to compile
// than the rest of a file that uses codes. The root stays out because an unused member of OpenVDB
// 10 does not compile; LeafNode::str has the same fault and is replaced.
template <>
std::string openvdb::tree::LeafNode<deltasplat::Code, 3>::str() const;
extern template class openvdb::tree::LeafNode<deltasplat::Code, 3>;
extern template class openvdb::tree::InternalNode<openvdb::tree::LeafNode<deltasplat::Code, 3>, 4>;
extern template class openvdb::tree::InternalNode<
    openvdb::tree::InternalNode<openvdb::tree::LeafNode<deltasplat::Code, 3>, 4>, 5>;
extern template class openvdb::tree::Tree<openvdb::tree::RootNode<openvdb::tree::InternalNode<
    openvdb::tree::InternalNode<openvdb::tree::LeafNode<deltasplat::Code, 3>, 4>, 5>>>;

namespace deltasplat {

struct CodeLeaf;
class LeafReader;
class SlotBlocks;

/// The codes of a volume. Either a tree in OpenVDB's standard layout (leaves of 8x8x8 voxels, x
/// slowest, z fastest), in which a uniform active block may be an active tile of any level and then
/// costs no memory. Or blocks along a slice axis, from which the tree is made on first use. Leaves,
/// too, may be read from their file on first use.
struct CodeTree {
    using Tree = openvdb::tree::Tree4<Code, 5, 4, 3>::Type;
    using Leaf = Tree::LeafNodeType;

    CodeTree() = default;
    /// Copies only the tree.
    CodeTree(const CodeTree& other) : tree_(other.tree()) {}
    /// Makes the tree in place: OpenVDB's trees cannot be moved.
    template <typename... Args>
    explicit CodeTree(std::in_place_t, Args&&... args) : tree_(std::forward<Args>(args)...) {}
    explicit CodeTree(std::shared_ptr<const SlotBlocks> blocks);
    ~CodeTree();

    /// For filling, before any call of leaves(). Not for codes that are made of blocks.
    Tree& tree() { return tree_; }
    /// Returns the tree, made on first use if there are blocks, with all leaves read. Thread-safe.
    /// @throw as readLeaves does
    const Tree& tree() const;
    /// Like tree(), but reads no leaf: for nodes, tiles and masks only.
    const Tree& nodes() const;
    /// The blocks of these codes if they lie along `sliceAxis`, else null.
    const SlotBlocks* blocksAlong(int sliceAxis) const;
    /// Returns the memory that the codes take now. Makes no tree.
    std::uint64_t memoryBytes() const;

    /// Lists the leaves with active voxels and their ranges of codes; readLeaves makes codes
    /// available. The tree must not change after the first call. Thread-safe.
    std::shared_ptr<const std::vector<CodeLeaf>> leaves() const;
    /// Reads those of this tree's `leaves` that have not been read. Thread-safe.
    /// @throw Error(kInput) if their file cannot be read or has changed; Error(kFailed) if codes do
    ///        not fit into memory. No leaf is read then, and the next call tries again.
    void readLeaves(std::span<const Leaf* const> leaves) const;
    bool lacksLeaves() const { return leftToRead_.load(std::memory_order_acquire) > 0; }
    /// Gives leaves() its list. The caller has filled the tree and must not change it afterwards.
    /// @param leaves  all leaves with active voxels, in any order
    /// @param reader  null, or reads leaves that have no room for codes yet, on first use
    void noteLeaves(std::vector<CodeLeaf> leaves,
                    std::unique_ptr<const LeafReader> reader = nullptr);

  private:
    void readAll() const;
    mutable Tree tree_{Code{0}};
    std::shared_ptr<const SlotBlocks> blocks_;  // null: there is only the tree
    mutable std::mutex mutex_;
    mutable std::atomic<bool> hasTree_ = false;  // only used with blocks
    mutable std::atomic<std::shared_ptr<const std::vector<CodeLeaf>>> leaves_;
    mutable std::atomic<std::size_t> leftToRead_ = 0;
    mutable std::unique_ptr<const LeafReader> reader_;  // null once all leaves are read
};

/// A leaf with active voxels and its range of codes, by which clear leaves are skipped unread.
struct CodeLeaf {
    const CodeTree::Leaf* leaf;
    openvdb::Coord origin;  // copied, so that listing does not touch the leaf
    Code lowest;
    Code highest;
};

/// Reads the codes of leaves from a file.
class LeafReader {
  public:
    LeafReader() = default;
    LeafReader(const LeafReader&) = delete;
    LeafReader& operator=(const LeafReader&) = delete;
    virtual ~LeafReader() = default;

    /// Gives leaves their codes, on all threads.
    /// @param leaves  without room for codes
    /// @throw Error(kInput) if their file cannot be read or has changed
    virtual void read(std::span<CodeTree::Leaf* const> leaves) const = 0;
};

/// @param leaf  has active voxels
CodeLeaf describeLeaf(const CodeTree::Leaf& leaf);
/// @param codes  of the leaf's active voxels, in any order
CodeLeaf describeLeaf(const CodeTree::Leaf& leaf, std::span<const Code> codes);

}  // namespace deltasplat
