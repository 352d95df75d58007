// SPDX-License-Identifier: Apache-2.0
#include "cut/cut_source.h"

#include "ingest/grids/grid_values.h"
#include "ingest/grids/scalar_grids.h"
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
    requireMemory("cut", double(volume.source->grid->memUsage()));
    volume.source->grid->apply<ScalarGrids>([&](const auto& grid) {
        const auto cut = grid.deepCopy();
        dropVoxels(cut->tree(), volume.codes->tree());
        if (!volume.codeBook.isExact()) {
            const GridScan scan = scanLeaves(TreeLeaves(cut->tree()), kNumbersAlone);
            volume.valueMin = scan.census.min;
            volume.valueMax = scan.census.max;
        }
        volume.source =
            std::make_shared<const SourceGrid>(SourceGrid{cut, volume.source->fileMetadata});
    });
}

}  // namespace deltasplat
