// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenVDB file format, as OpenVDB 10's headers write it (Tree.h, RootNode.h,
// InternalNode.h, LeafNode*.h).
#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/Maps.h>
#include <openvdb/tree/Tree.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "formats/vdb/packed_values.h"
#include "volume/tree_grid.h"
#include "volume/vdb_metadata.h"

namespace deltasplat {

/// OpenVDB's notes of a tree besides its values.
struct TreeFacts {
    std::string type;                ///< of values: "float", "int32", ...
    std::uint64_t activeVoxels = 0;  ///< voxels of tiles included
    std::uint64_t memoryBytes = 0;   ///< of the tree in OpenVDB
    openvdb::CoordBBox activeBox;    ///< of active voxels
};

/// Leaves as a file has them, and the notes of "file_delayed_load": the kinds of inactive values
/// (openvdb::io's NO_MASK_..., MASK_...), and the sizes of packed values with their size field.
struct PackedLeaves {
    std::string bytes;
    std::vector<std::int8_t> kinds;
    std::vector<std::int64_t> sizes;
};

/// A tree ready for a .vdb file: packed by Blosc, inactive values left out where OpenVDB does so.
class WrittenTree {
  public:
    virtual ~WrittenTree() = default;

    virtual TreeFacts facts() const = 0;
    /// Returns the bytes before the leaf values.
    /// @param half  whether real values are stored as halves
    virtual std::string topology(bool half) const = 0;
    virtual std::size_t leafCount() const = 0;
    /// Whether OpenVDB notes leaf sizes: for numbers and vectors, not for bools and masks.
    virtual bool notesLeaves() const = 0;
    /// Appends leaves in file order. Thread-safe.
    virtual void packLeaves(std::size_t begin, std::size_t end, bool half,
                            PackedLeaves& to) const = 0;
};

/// A grid ready for a .vdb file.
struct WrittenGrid {
    std::string name;
    VdbMetadata metadata;  ///< keys of fileMetadata() are set anew
    openvdb::math::MapBase::ConstPtr map;
    std::shared_ptr<const WrittenTree> tree;
    bool packsNotes = true;  ///< whether the notes of leaf sizes are packed, as OpenVDB does

    /// Whether the metadata store real values as halves.
    bool isHalf() const;
};

/// Returns a scalar grid or one of vec3s ready for writing. Its tree is shared and must not change.
/// @throw Error(kFailed) for other types
WrittenGrid writtenGrid(const TreeGrid& grid);

/// Does the same for a grid of words (word_tree.h). Its leaf notes stay unpacked, because words do
/// not pack and Blosc takes longer to load than words take to read.
WrittenGrid writtenWords(const TreeGrid& grid);

/// Does the same faster for deltas of int32 or int64 with background 0. Inactive values are lost.
WrittenGrid writtenDeltas(const TreeGrid& grid);

/// Source of TreeWriter for an OpenVDB tree, which is written unchanged.
template <typename T>
class OwnValues {
  public:
    using Tree = T;     ///< has the nodes
    using Written = T;  ///< as the file has it
    using Leaf = typename Tree::LeafNodeType;
    using Value = typename Tree::ValueType;

    explicit OwnValues(std::shared_ptr<const Tree> tree) : tree_(std::move(tree)) {}

    const Tree& tree() const { return *tree_; }
    Value background() const { return tree_->background(); }
    Value ofTile(const Value& stored, bool) const { return stored; }
    LeafNote appendLeaf(const Leaf& leaf, bool half, std::string& to) const {
        return appendNode(leaf.buffer().data(), leaf.getValueMask(), {}, background(), half, to);
    }

    void appendBools(const Leaf& leaf, std::string& to) const {
        to.append(reinterpret_cast<const char*>(leaf.buffer().data()), sizeof leaf.getValueMask());
    }

  private:
    std::shared_ptr<const Tree> tree_;
};

/// Source of TreeWriter for deltas: writes active values alone, because others mean nothing.
template <typename T>
class DeltaValues : public OwnValues<T> {
  public:
    using typename OwnValues<T>::Leaf;
    using OwnValues<T>::OwnValues;

    LeafNote appendLeaf(const Leaf& leaf, bool, std::string& to) const {
        constexpr std::int8_t kKind = openvdb::io::NO_MASK_OR_INACTIVE_VALS;
        appendBytes(kKind, to);
        std::array<typename T::ValueType, Leaf::SIZE> values;
        std::size_t count = 0;
        const auto* const all = leaf.buffer().data();
        forBits(leaf.getValueMask(), [&](std::size_t i) { values[count++] = all[i]; });
        return {kKind, appendStored(values.data(), count, false, to)};
    }
};

/// @tparam Source  provides the values of its nodes: OwnValues or a class with the same interface
template <typename Source>
class TreeWriter : public WrittenTree {
  public:
    using Tree = typename Source::Tree;
    using Leaf = typename Tree::LeafNodeType;
    using Written = typename Source::Written;
    using Value = typename Written::ValueType;

    explicit TreeWriter(Source source) : source_(std::move(source)) {
        source_.tree().getNodes(leaves_);
    }

    TreeFacts facts() const override {
        const Tree& tree = source_.tree();
        TreeFacts facts;
        facts.type = openvdb::typeNameAsString<typename Written::BuildType>();
        facts.activeVoxels = tree.activeVoxelCount();
        tree.evalActiveVoxelBoundingBox(facts.activeBox);
        const auto counts = tree.nodeCount();  // leaves first, the root last
        using Root = typename Written::RootNodeType;
        using Upper = typename Root::ChildNodeType;
        facts.memoryBytes = sizeof(Written) + sizeof(Root) + counts[0] * leafMemory() +
                            counts[1] * nodeMemory<typename Upper::ChildNodeType>() +
                            counts[2] * nodeMemory<Upper>();
        return facts;
    }

    std::string topology(bool half) const override {
        std::string bytes;
        const auto& root = source_.tree().root();
        const Value background = source_.background();
        appendBytes(std::uint32_t{1}, bytes);  // buffers
        appendBytes(half ? Value(openvdb::io::truncateRealToHalf(background)) : background, bytes);
        std::uint32_t tiles = 0;
        std::string tileBytes;
        for (auto tile = root.cbeginValueAll(); tile; ++tile, ++tiles) {
            appendPlace(tile.getCoord(), tileBytes);
            appendBytes(source_.ofTile(*tile, tile.isValueOn()), tileBytes);
            appendBytes(tile.isValueOn(), tileBytes);
        }
        appendBytes(tiles, bytes);
        appendBytes(std::uint32_t(root.childCount()), bytes);
        bytes += tileBytes;
        for (auto child = root.cbeginChildOn(); child; ++child) {
            appendPlace(child.getCoord(), bytes);
            appendInner(*child, half, bytes);
        }
        return bytes;
    }

    std::size_t leafCount() const override { return leaves_.size(); }
    bool notesLeaves() const override { return !kIsBool; }

    void packLeaves(std::size_t begin, std::size_t end, bool half,
                    PackedLeaves& to) const override {
        for (std::size_t i = begin; i < end; ++i) {
            const Leaf& leaf = *leaves_[i];
            appendBytes(leaf.getValueMask(), to.bytes);
            if constexpr (kIsBool) {
                appendPlace(leaf.origin(), to.bytes);
                if constexpr (!kIsMask) source_.appendBools(leaf, to.bytes);
            } else {
                const LeafNote note = source_.appendLeaf(leaf, half, to.bytes);
                to.kinds.push_back(note.kind);
                to.sizes.push_back(note.size);
            }
        }
    }

  private:
    static constexpr bool kIsBool = std::is_same_v<Value, bool>;
    static constexpr bool kIsMask = std::is_same_v<typename Written::BuildType, openvdb::ValueMask>;

    static constexpr std::uint64_t leafMemory() {
        using WrittenLeaf = typename Written::LeafNodeType;
        return sizeof(WrittenLeaf) + (kIsBool ? 0 : WrittenLeaf::SIZE * sizeof(Value));
    }

    template <typename Node>
    static constexpr std::uint64_t nodeMemory() {
        return Node::NUM_VALUES * sizeof(typename Node::UnionType) +
               2 * sizeof(typename Node::NodeMaskType) + sizeof(openvdb::Coord);
    }

    static void appendPlace(const openvdb::Coord& place, std::string& to) {
        to.append(reinterpret_cast<const char*>(place.data()), 3 * sizeof(openvdb::Int32));
    }

    // Appends an inner node and the nodes below.
    template <typename Node>
    void appendInner(const Node& node, bool half, std::string& to) const {
        const auto& children = node.getChildMask();
        const auto& active = node.getValueMask();
        appendBytes(children, to);
        appendBytes(active, to);
        // Children need no value, only their place in the mask.
        const auto values = std::make_unique<Value[]>(Node::NUM_VALUES);
        for (auto tile = node.cbeginValueAll(); tile; ++tile)
            values[tile.pos()] = source_.ofTile(*tile, tile.isValueOn());
        appendNode(values.get(), active, children, source_.background(), half, to);
        for (auto child = node.cbeginChildOn(); child; ++child) {
            if constexpr (Node::LEVEL > 1) {
                appendInner(*child, half, to);
            } else {
                appendBytes(child->getValueMask(), to);
            }
        }
    }

    Source source_;
    std::vector<const Leaf*> leaves_;  // depth first, as a file has them
};

}  // namespace deltasplat
