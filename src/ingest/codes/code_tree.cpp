// SPDX-License-Identifier: Apache-2.0
#include "ingest/codes/code_tree.h"

#include <algorithm>

#include "parallel.h"

namespace deltasplat {

CodeLeaf describeLeaf(const CodeTree::Leaf& leaf) {
    const Code* codes = leaf.buffer().data();
    CodeLeaf described{&leaf, codes[leaf.valueMask().findFirstOn()], 0};
    const auto add = [&](Code code) {
        described.lowest = std::min(described.lowest, code);
        described.highest = std::max(described.highest, code);
    };
    if (leaf.isDense()) {
        for (openvdb::Index n = 0; n < CodeTree::Leaf::SIZE; ++n) add(codes[n]);
    } else {
        for (auto on = leaf.valueMask().beginOn(); on; ++on) add(codes[on.pos()]);
    }
    return described;
}

namespace {

std::vector<CodeLeaf> listLeaves(const CodeTree::Tree& tree) {
    std::vector<const CodeTree::Leaf*> leaves;
    tree.getNodes(leaves);
    // Leaves without active voxels may lie outside of the box of those.
    std::erase_if(leaves, [](const CodeTree::Leaf* leaf) { return leaf->isEmpty(); });
    std::vector<CodeLeaf> described(leaves.size());
    parallelForChunks(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) described[i] = describeLeaf(*leaves[i]);
    });
    return described;
}

}  // namespace

std::shared_ptr<const std::vector<CodeLeaf>> CodeTree::leaves() const {
    auto known = leaves_.load();
    if (known) return known;
    // Two threads may do this at once; the lists are the same.
    known = std::make_shared<const std::vector<CodeLeaf>>(listLeaves(tree));
    leaves_.store(known);
    return known;
}

}  // namespace deltasplat
