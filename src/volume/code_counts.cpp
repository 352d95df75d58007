// SPDX-License-Identifier: Apache-2.0
#include "volume/code_counts.h"

#include "volume/grid_values.h"

namespace deltasplat {

std::vector<std::uint64_t> histogramOf(const CodeTree::Tree& tree) {
    std::vector<const CodeTree::Leaf*> leaves;
    tree.getNodes(leaves);
    CodeCounts counts;
    forLeafRuns(leaves.size(), counts.workers(),
                [&](std::size_t worker, std::size_t begin, std::size_t end) {
                    LeafRoom<CodeTree::Leaf> room;
                    for (std::size_t i = begin; i < end; ++i)
                        counts.add(worker, activeValues(*leaves[i], room));
                });
    forActiveTiles(tree, [&](const auto& tile) { counts.add(0, *tile, tile.getVoxelCount()); });
    return counts.take();
}

IndexBox activeBox(const CodeTree::Tree& tree) {
    openvdb::CoordBBox box;
    if (!tree.evalActiveVoxelBoundingBox(box)) return {};
    return {{box.min().x(), box.min().y(), box.min().z()},
            {box.max().x(), box.max().y(), box.max().z()}};
}

}  // namespace deltasplat
