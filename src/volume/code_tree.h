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

// The code of the tree's nodes is generated once, in code_tree.cpp: it takes longer to compile than
// all else in a file that uses codes. The root stays out, because a member of OpenVDB 10's that
// nobody calls does not compile; such a member of the leaf's is replaced.
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

/// The codes of a volume: in OpenVDB's standard layout (leaves of 8x8x8 voxels, x slowest, z
/// fastest), where a uniform active 8x8x8 block may be an active tile at any level, so that a large
/// constant region costs no memory; or as blocks that lie along a slice axis, of which the tree is
/// made when it is first asked for. Leaves may be read when they are first asked for, too.
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
    ~CodeTree();

    /// To be filled, before anybody asks for leaves(); not of one made of blocks.
    Tree& tree() { return tree_; }
    /// Thread-safe. Of one made of blocks the first call makes the tree; leaves that are left to be
    /// read are read.
    /// @throw what readLeaves throws
    const Tree& tree() const;
    /// Does the same for who looks at nodes, tiles and masks alone: no leaf is read.
    const Tree& nodes() const;
    /// The blocks that this is made of, if they lie along an axis; else null.
    const SlotBlocks* blocksAlong(int sliceAxis) const;
    /// Returns how much memory codes take, without making anything.
    std::uint64_t memoryBytes() const;

    /// Lists the leaves that have active voxels, with the ranges of their codes: made on the first
    /// call, after which the tree must not change. Thread-safe. Codes are there once readLeaves was
    /// called for them.
    std::shared_ptr<const std::vector<CodeLeaf>> leaves() const;
    /// Reads those of this tree's leaves that nobody has asked for yet. Thread-safe.
    /// @throw Error(kInput) if their file cannot be read, or is not what it was; Error(kFailed) if
    ///        codes do not fit into memory. No leaf is read then, and the next call tries again.
    void readLeaves(std::span<const Leaf* const> leaves) const;
    /// Whether there may be leaves that are not read yet.
    bool lacksLeaves() const { return leftToRead_.load(std::memory_order_acquire) > 0; }
    /// Tells leaves() what it would find out, for who has filled the tree: it must not change then.
    /// @param leaves  all that have active voxels, in any order
    /// @param reader  null, or reads those that have no room for codes yet when they are asked for
    void noteLeaves(std::vector<CodeLeaf> leaves,
                    std::unique_ptr<const LeafReader> reader = nullptr);

  private:
    void readAll() const;
    mutable Tree tree_{Code{0}};
    std::shared_ptr<const SlotBlocks> blocks_;  // null: the tree is all that there is
    mutable std::mutex mutex_;
    mutable std::atomic<bool> hasTree_ = false;  // if there are blocks
    mutable std::atomic<std::shared_ptr<const std::vector<CodeLeaf>>> leaves_;
    mutable std::atomic<std::size_t> leftToRead_ = 0;
    mutable std::unique_ptr<const LeafReader> reader_;  // null once none is left
};

/// A leaf of a code tree that has active voxels, and the range of their codes: those which a
/// transfer function makes clear are passed over without being read.
struct CodeLeaf {
    const CodeTree::Leaf* leaf;
    openvdb::Coord origin;  // of the leaf, which is then not looked at
    Code lowest;
    Code highest;
};

/// Reads leaves of codes from where these lie.
class LeafReader {
  public:
    LeafReader() = default;
    LeafReader(const LeafReader&) = delete;
    LeafReader& operator=(const LeafReader&) = delete;
    virtual ~LeafReader() = default;

    /// Gives leaves their codes, on all threads.
    /// @param leaves  without room for codes
    /// @throw Error(kInput) if their file cannot be read, or is not what it was
    virtual void read(std::span<CodeTree::Leaf* const> leaves) const = 0;
};

/// @param leaf  one that has active voxels
CodeLeaf describeLeaf(const CodeTree::Leaf& leaf);
/// @param codes  of its active voxels, in any order
CodeLeaf describeLeaf(const CodeTree::Leaf& leaf, std::span<const Code> codes);

}  // namespace deltasplat
