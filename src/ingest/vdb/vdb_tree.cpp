// SPDX-License-Identifier: Apache-2.0
#include "ingest/vdb/vdb_tree.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "heap_growth.h"
#include "ingest/vdb/packed_values.h"
#include "parallel.h"
#include "shared_progress.h"

namespace deltasplat {
namespace {

openvdb::Coord placeOf(const std::array<std::int32_t, 3>& origin) {
    return openvdb::Coord(origin.data());
}

template <typename T>
class TreeReader {
  public:
    using Tree = typename openvdb::tree::Tree4<T, 5, 4, 3>::Type;
    using Upper = typename Tree::RootNodeType::ChildNodeType;
    using Lower = typename Upper::ChildNodeType;
    using Leaf = typename Lower::ChildNodeType;

    TreeReader(const FileBytes& file, const VdbValueFormat& format, T background,
               const std::vector<VdbNode>& nodes, const VdbLeaves& leaves)
        : file_(file), format_(format), background_(background), nodes_(nodes), leaves_(leaves) {}

    typename Tree::Ptr read(const Listener& listener) {
        auto tree = std::make_shared<Tree>(background_);
        readInner(*tree);
        if (isSound_) readLeaves(listener);
        return whole(std::move(tree));
    }

    typename Tree::Ptr readNodes() {
        auto tree = std::make_shared<Tree>(background_);
        readInner(*tree);
        if (isSound_) noteLeaves();
        return whole(std::move(tree));
    }

  private:
    // Puts together what has been read.
    typename Tree::Ptr whole(typename Tree::Ptr tree) {
        if (!isSound_) return nullptr;
        for (auto& [origin, lower] : lowers_)
            uppers_.at(origin & ~(Upper::DIM - 1))->addChild(lower.release());
        for (auto& [origin, upper] : uppers_) tree->root().addChild(upper.release());
        return tree;
    }

    // Reads nodes, and tiles of the root.
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
        T value;
        if (file_.read(node.begin, reinterpret_cast<char*>(&value), sizeof value) != sizeof value) {
            isSound_ = false;
            return;
        }
        tree.root().addTile(placeOf(node.origin), value, node.tiles > 0);
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
        std::vector<T> values(Node::NUM_VALUES);
        std::vector<char> stored;
        if (!isThere || !unpackAll(std::span<const char>(bytes).subspan(all.size_bytes()), active,
                                   format_, background_, stored, values.data())) {
            isSound_ = false;
            return nullptr;
        }
        auto made = std::make_unique<Node>(placeOf(node.origin), background_, /*active=*/false);
        for (openvdb::Index i = 0; i < Node::NUM_VALUES; ++i) {
            const auto has = [&](const auto& mask) { return (mask[i / 64] >> (i % 64) & 1) != 0; };
            if (!has(children)) made->addTile(i, values[i], has(active));
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
        // What Blosc takes for a moment leaves gaps.
        expectPieces(std::size_t(1.5 * (sizeof(Leaf) + Leaf::SIZE * sizeof(T))));
        auto made = std::make_unique<Leaf>(openvdb::PartialCreate(), placeOf(leaf.origin));
        made->allocate();
        VdbLeaves::Mask mask;
        if (!leaves_.allValues(leaf, background_, behind, mask, room, made->buffer().data()))
            return nullptr;
        typename Leaf::NodeMaskType active;
        for (openvdb::Index x = 0; x < mask.size(); ++x)
            active.template getWord<std::uint64_t>(x) = mask[x];
        made->setValueMask(active);
        return made;
    }

    const FileBytes& file_;
    const VdbValueFormat& format_;
    T background_;
    const std::vector<VdbNode>& nodes_;
    const VdbLeaves& leaves_;
    std::map<openvdb::Coord, std::unique_ptr<Upper>> uppers_;
    std::map<openvdb::Coord, std::unique_ptr<Lower>> lowers_;
    Lower* lastNode_ = nullptr;  // that a leaf was hung into
    std::atomic<bool> isSound_ = true;
};

}  // namespace

template <typename T>
typename openvdb::tree::Tree4<T, 5, 4, 3>::Type::Ptr readTree(
    const FileBytes& file, const VdbValueFormat& format, T background,
    const std::vector<VdbNode>& nodes, const VdbLeaves& leaves, const Listener& listener) {
    return TreeReader<T>(file, format, background, nodes, leaves).read(listener);
}

template <typename T>
typename openvdb::tree::Tree4<T, 5, 4, 3>::Type::Ptr readNodes(const FileBytes& file,
                                                               const VdbValueFormat& format,
                                                               T background,
                                                               const std::vector<VdbNode>& nodes,
                                                               const VdbLeaves& leaves) {
    return TreeReader<T>(file, format, background, nodes, leaves).readNodes();
}

#define DELTASPLAT_READ_TREE(T)                                                                    \
    template openvdb::tree::Tree4<T, 5, 4, 3>::Type::Ptr readTree(                                 \
        const FileBytes&, const VdbValueFormat&, T, const std::vector<VdbNode>&, const VdbLeaves&, \
        const Listener&);                                                                          \
    template openvdb::tree::Tree4<T, 5, 4, 3>::Type::Ptr readNodes(                                \
        const FileBytes&, const VdbValueFormat&, T, const std::vector<VdbNode>&,                   \
        const VdbLeaves&);
DELTASPLAT_READ_TREE(float)
DELTASPLAT_READ_TREE(double)
DELTASPLAT_READ_TREE(std::int32_t)
DELTASPLAT_READ_TREE(std::int64_t)
#undef DELTASPLAT_READ_TREE

}  // namespace deltasplat
