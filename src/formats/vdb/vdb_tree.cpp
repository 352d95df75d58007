// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/vdb_tree.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <map>
#include <type_traits>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "formats/vdb/packed_values.h"
#include "volume/tree_grid.h"

namespace deltasplat {

namespace {

openvdb::Coord placeOf(const std::array<std::int32_t, 3>& origin) {
    return openvdb::Coord(origin.data());
}

// The stored type of a value: for a bool a byte, which may hold anything.
template <typename T>
using StoredValue = std::conditional_t<std::is_same_v<T, bool>, std::uint8_t, T>;

template <typename Tree>
class TreeReader {
  public:
    using T = typename Tree::ValueType;
    using Stored = StoredValue<T>;
    using Upper = typename Tree::RootNodeType::ChildNodeType;
    using Lower = typename Upper::ChildNodeType;
    using Leaf = typename Lower::ChildNodeType;

    TreeReader(const FileBytes& file, const VdbValueFormat& format, const Stored& background,
               const std::vector<VdbNode>& nodes, const VdbLeaves& leaves)
        : file_(file), format_(format), background_(background), nodes_(nodes), leaves_(leaves) {}

    typename Tree::Ptr read(const Listener& listener) {
        auto tree = std::make_shared<Tree>(T(background_));
        readInner(*tree);
        if (isSound_) readLeaves(listener);
        return whole(std::move(tree));
    }

    typename Tree::Ptr readNodes() {
        auto tree = std::make_shared<Tree>(T(background_));
        readInner(*tree);
        if (isSound_) noteLeaves();
        return whole(std::move(tree));
    }

  private:
    // Joins the nodes that have been read.
    typename Tree::Ptr whole(typename Tree::Ptr tree) {
        if (!isSound_) return nullptr;
        for (auto& [origin, lower] : lowers_)
            uppers_.at(origin & ~(Upper::DIM - 1))->addChild(lower.release());
        for (auto& [origin, upper] : uppers_) tree->root().addChild(upper.release());
        return tree;
    }

    // Reads inner nodes and root tiles.
    void readInner(Tree& tree) {
        std::vector<std::unique_ptr<Upper>> uppers(nodes_.size());
        std::vector<std::unique_ptr<Lower>> lowers(nodes_.size());
        parallelFor(nodes_.size(), [&](std::size_t i) {
            if (nodes_[i].level == 2) uppers[i] = readNode<Upper>(nodes_[i]);
            if (nodes_[i].level == 1) lowers[i] = readNode<Lower>(nodes_[i]);
        });
        for (std::size_t i = 0; i < nodes_.size() && isSound_; ++i) {
            const openvdb::Coord origin = placeOf(nodes_[i].origin);
            if (uppers[i]) uppers_[origin] = std::move(uppers[i]);
            if (lowers[i]) lowers_[origin] = std::move(lowers[i]);
            if (nodes_[i].level == 3) readRootTile(nodes_[i], tree);
        }
    }

    void readRootTile(const VdbNode& node, Tree& tree) {
        std::vector<char> stored(format_.alone);
        if (file_.read(node.begin, stored.data(), stored.size()) != stored.size()) {
            isSound_ = false;
            return;
        }
        tree.root().addTile(placeOf(node.origin), T(valueAlone<Stored>(stored.data(), format_)),
                            node.tiles > 0);
    }

    template <typename Node>
    std::unique_ptr<Node> readNode(const VdbNode& node) {
        std::vector<char> bytes(node.size);
        std::vector<std::uint64_t> masks(2 * Node::NUM_VALUES / 64);
        const std::span<const std::uint64_t> all(masks);
        const bool isThere = file_.read(node.begin, bytes.data(), node.size) == node.size &&
                             node.size >= all.size_bytes();
        if (isThere) std::memcpy(masks.data(), bytes.data(), all.size_bytes());
        const auto children = all.first(all.size() / 2);
        const auto active = all.last(all.size() / 2);
        std::vector<Stored> values(Node::NUM_VALUES);
        std::vector<char> stored;
        if (!isThere || !unpackAll(std::span<const char>(bytes).subspan(all.size_bytes()), active,
                                   format_, background_, stored, values.data())) {
            isSound_ = false;
            return nullptr;
        }
        auto made = std::make_unique<Node>(placeOf(node.origin), T(background_), /*active=*/false);
        for (openvdb::Index i = 0; i < Node::NUM_VALUES; ++i) {
            const auto has = [&](const auto& mask) { return (mask[i / 64] >> (i % 64) & 1) != 0; };
            if (!has(children)) made->addTile(i, T(values[i]), has(active));
        }
        return made;
    }

    void readLeaves(const Listener& listener) {
        constexpr std::size_t kRun = VdbLeaves::kRun;
        const std::size_t count = leaves_.leaves().size();
        std::vector<std::unique_ptr<Leaf>> leaves(count);
        SharedProgress progress(listener);
        std::atomic<std::size_t> done = 0;
        parallelFor((count + kRun - 1) / kRun, [&](std::size_t run) {
            VdbLeaves::BytesRoom room;
            const std::size_t end = std::min(count, (run + 1) * kRun);
            for (std::size_t i = run * kRun; i < end && isSound_; ++i) {
                leaves[i] = readLeaf(leaves_.leaves()[i], end, room);
                if (!leaves[i]) isSound_ = false;
            }
            progress.report(double(done += kRun) / double(count + kRun));
        });
        for (std::size_t i = 0; i < count && isSound_; ++i) hangIn(std::move(leaves[i]));
    }

    void noteLeaves() {
        for (std::size_t i = 0; i < leaves_.leaves().size(); ++i) {
            auto leaf = std::make_unique<Leaf>(openvdb::PartialCreate(),
                                               placeOf(leaves_.leaves()[i].origin));
            leaf->setTransientData(openvdb::Index32(i));
            hangIn(std::move(leaf));
        }
    }

    void hangIn(std::unique_ptr<Leaf> leaf) {
        const openvdb::Coord origin = leaf->origin() & ~(Lower::DIM - 1);
        if (!lastNode_ || lastNode_->origin() != origin) lastNode_ = lowers_.at(origin).get();
        lastNode_->addChild(leaf.release());
    }

    std::unique_ptr<Leaf> readLeaf(const VdbLeaf& leaf, std::size_t behind,
                                   VdbLeaves::BytesRoom& room) const {
        // Blosc's temporary memory leaves gaps.
        expectPieces(std::size_t(1.5 * (sizeof(Leaf) + Leaf::SIZE * sizeof(T))));
        auto made = std::make_unique<Leaf>(openvdb::PartialCreate(), placeOf(leaf.origin));
        made->allocate();
        VdbLeaves::Mask mask;
        if (!readValues(leaf, behind, room, mask, *made)) return nullptr;
        typename Leaf::NodeMaskType active;
        for (openvdb::Index x = 0; x < mask.size(); ++x)
            active.template getWord<std::uint64_t>(x) = mask[x];
        made->setValueMask(active);
        return made;
    }

    bool readValues(const VdbLeaf& leaf, std::size_t behind, VdbLeaves::BytesRoom& room,
                    VdbLeaves::Mask& mask, Leaf& made) const {
        auto* const values = made.buffer().data();
        if constexpr (std::is_same_v<T, bool>) {
            VdbLeaves::Mask bits;
            if (!leaves_.allBools(leaf, behind, mask, room.run, bits)) return false;
            std::copy(bits.begin(), bits.end(), values);
            return true;
        } else {
            return leaves_.allValues(leaf, background_, behind, mask, room, values);
        }
    }

    const FileBytes& file_;
    const VdbValueFormat& format_;
    Stored background_;
    const std::vector<VdbNode>& nodes_;
    const VdbLeaves& leaves_;
    std::map<openvdb::Coord, std::unique_ptr<Upper>> uppers_;
    std::map<openvdb::Coord, std::unique_ptr<Lower>> lowers_;
    Lower* lastNode_ = nullptr;  // parent of the last leaf
    std::atomic<bool> isSound_ = true;
};

}  // namespace

openvdb::tree::TreeBase::Ptr readTree(const FileBytes& file, const std::string& type,
                                      const VdbValueFormat& format,
                                      std::span<const char> background,
                                      const std::vector<VdbNode>& nodes, const VdbLeaves& leaves,
                                      const Listener& listener) {
    using Trees = TreeTypes<openvdb::FloatTree, openvdb::DoubleTree, openvdb::Int32Tree,
                            openvdb::Int64Tree, openvdb::BoolTree, openvdb::MaskTree,
                            openvdb::Vec3STree, openvdb::Vec3DTree, openvdb::Vec3ITree>;
    openvdb::tree::TreeBase::Ptr tree;
    applyType(Trees(), type == kHalfType ? "float" : type,
              [&]<typename Tree>(std::type_identity<Tree>) {
                  const auto value =
                      valueAlone<StoredValue<typename Tree::ValueType>>(background.data(), format);
                  tree = TreeReader<Tree>(file, format, value, nodes, leaves).read(listener);
              });
    return tree;
}

template <typename T>
typename openvdb::tree::Tree4<T, 5, 4, 3>::Type::Ptr readNodes(const FileBytes& file,
                                                               const VdbValueFormat& format,
                                                               T background,
                                                               const std::vector<VdbNode>& nodes,
                                                               const VdbLeaves& leaves) {
    using Tree = typename openvdb::tree::Tree4<T, 5, 4, 3>::Type;
    return TreeReader<Tree>(file, format, background, nodes, leaves).readNodes();
}

#define DELTASPLAT_READ_NODES(T)                                                 \
    template openvdb::tree::Tree4<T, 5, 4, 3>::Type::Ptr readNodes(              \
        const FileBytes&, const VdbValueFormat&, T, const std::vector<VdbNode>&, \
        const VdbLeaves&);
DELTASPLAT_READ_NODES(float)
DELTASPLAT_READ_NODES(double)
DELTASPLAT_READ_NODES(std::int32_t)
DELTASPLAT_READ_NODES(std::int64_t)
#undef DELTASPLAT_READ_NODES

namespace {

// A node has 2^log2 children along each axis, each of 2^childLog2 voxels.
struct NodeShape {
    int log2;
    int childLog2;
};

constexpr NodeShape shapeOf(int level) {
    return level == 1 ? NodeShape{4, 3} : NodeShape{5, 7};
}

openvdb::Coord placeOf(const VdbNode& node, int child) {
    const auto [log2, childLog2] = shapeOf(node.level);
    const int mask = (1 << log2) - 1;
    return openvdb::Coord(node.origin.data())
        .offsetBy((child >> (2 * log2)) << childLog2, (child >> log2 & mask) << childLog2,
                  (child & mask) << childLog2);
}

// Writes a stored value in the grid's type.
void writeValue(const char* stored, const VdbValueFormat& format, char* to) {
    if (!format.areHalves()) {
        std::memcpy(to, stored, format.bytes);
        return;
    }
    openvdb::math::half half;
    std::memcpy(&half, stored, sizeof half);
    const auto single = float(half);
    const auto wide = double(single);
    std::memcpy(to, format.bytes == sizeof wide ? static_cast<const void*>(&wide) : &single,
                format.bytes);
}

// Writes the places and values of a node's tiles. Returns whether the node is sound.
bool readNode(const FileBytes& file, const VdbValueFormat& format, const VdbNode& node,
              TilePlace* places, char* values) {
    std::vector<char> bytes(node.size);
    if (file.read(node.begin, bytes.data(), node.size) != node.size) return false;
    if (node.level == 3) {
        *places = {openvdb::Coord(node.origin.data()), 3};
        if (format.alone == format.bytes) {
            std::copy(bytes.begin(), bytes.end(), values);
        } else {
            writeValue(bytes.data(), format, values);
        }
        return true;
    }
    const std::size_t children = std::size_t{1} << (3 * shapeOf(node.level).log2);
    std::vector<std::uint64_t> mask(children / 64);
    const std::span<const std::uint64_t> active(mask);
    if (bytes.size() < 2 * active.size_bytes()) return false;
    std::memcpy(mask.data(), bytes.data() + active.size_bytes(), active.size_bytes());
    const auto packed =
        packedValues(std::span<const char>(bytes).subspan(2 * active.size_bytes()), active, format);
    if (!packed) return false;
    std::vector<char> stored(children * format.stored + kUnpackBytes);
    if (!unpack(*packed, format, stored)) return false;
    const bool haveAll = packed->count == children;
    std::size_t next = 0;
    for (std::size_t word = 0; word < mask.size(); ++word) {
        for (std::uint64_t left = mask[word]; left != 0; left &= left - 1, ++next) {
            // The file has changed since the walk.
            if (next == node.tiles) return false;
            const std::size_t child = 64 * word + std::size_t(std::countr_zero(left));
            places[next] = {placeOf(node, int(child)), openvdb::Index(node.level)};
            writeValue(stored.data() + format.stored * (haveAll ? child : next), format,
                       values + format.bytes * next);
        }
    }
    return next == node.tiles;
}

}  // namespace

std::optional<VdbTiles> VdbTiles::read(const FileBytes& file, const VdbValueFormat& format,
                                       const std::vector<VdbNode>& nodes) {
    std::vector<std::size_t> begins;
    std::size_t count = 0;
    for (const VdbNode& node : nodes) {
        begins.push_back(count);
        count += node.tiles;
    }
    VdbTiles tiles;
    tiles.places_.resize(count);
    tiles.values_.resize(count * format.bytes);
    std::atomic<bool> areSound = true;
    parallelFor(nodes.size(), [&](std::size_t i) {
        if (nodes[i].tiles == 0) return;
        if (!readNode(file, format, nodes[i], &tiles.places_[begins[i]],
                      &tiles.values_[begins[i] * format.bytes]))
            areSound = false;
    });
    if (!areSound) return std::nullopt;
    return tiles;
}

}  // namespace deltasplat
