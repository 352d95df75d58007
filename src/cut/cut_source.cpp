// SPDX-License-Identifier: Apache-2.0
#include "cut/cut_source.h"

#include "ingest/grids/grid_values.h"
#include "ingest/grids/source_grid.h"
#include "memory.h"

namespace deltasplat {
namespace {

// Switches off what is not active in the codes, and gives it the background's value; tiles keep
// theirs, which nothing reads.
template <typename Tree>
void dropVoxels(Tree& tree, const CodeTree::Tree& kept) {
    const openvdb::MaskTree before(tree, false, true, openvdb::TopologyCopy());
    tree.topologyIntersection(kept);
    std::vector<typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    forLeafRuns(leaves.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (auto off = leaves[i]->beginValueOff(); off; ++off) {
                if (before.isValueOn(off.getCoord()))
                    leaves[i]->setValueOff(off.pos(), tree.background());
            }
        }
    });
}

}  // namespace

void cutSource(Volume& volume) {
    SourceGrid cut{volume.source->grid, volume.source->fileMetadata};
    requireMemory("cut", double(cut.grid.tree->memUsage()));
    cut.grid.tree = cut.grid.tree->copy();
    cut.grid.apply<ScalarTrees>([&](auto& tree) {
        dropVoxels(tree, volume.codes->tree());
        if (!volume.codeBook.isExact()) {
            const GridScan scan = scanLeaves(TreeLeaves(tree), kNumbersAlone);
            volume.valueMin = scan.census.min;
            volume.valueMax = scan.census.max;
        }
    });
    volume.source = std::make_shared<const SourceGrid>(std::move(cut));
}

}  // namespace deltasplat
