// SPDX-License-Identifier: Apache-2.0
#include "ingest/codes/code_statistics.h"

#include <algorithm>

#include "deltasplat/threads.h"
#include "ingest/grids/grid_values.h"
#include "parallel.h"

namespace deltasplat {

std::vector<std::uint64_t> histogramOf(const CodeTree::Tree& tree) {
    std::vector<const CodeTree::Leaf*> leaves;
    tree.getNodes(leaves);
    // Histograms are large: one for each thread, not for each piece of work.
    const std::size_t strips = std::size_t(std::max(1, threadCount()));
    std::vector<std::vector<std::uint64_t>> counts(strips);
    parallelFor(strips, [&](std::size_t strip) {
        counts[strip].resize(kCodeCount);
        for (std::size_t i = strip; i < leaves.size(); i += strips) {
            const Code* codes = leaves[i]->buffer().data();
            for (auto on = leaves[i]->valueMask().beginOn(); on; ++on)
                ++counts[strip][codes[on.pos()]];
        }
    });
    std::vector<std::uint64_t>& sum = counts[0];
    for (std::size_t strip = 1; strip < strips; ++strip) {
        for (std::size_t code = 0; code < sum.size(); ++code) sum[code] += counts[strip][code];
    }
    forActiveTiles(tree, [&](const auto& tile) { sum[*tile] += tile.getVoxelCount(); });
    return std::move(sum);
}

IndexBox activeBox(const CodeTree::Tree& tree) {
    openvdb::CoordBBox box;
    if (!tree.evalActiveVoxelBoundingBox(box)) return {};
    return {{box.min().x(), box.min().y(), box.min().z()},
            {box.max().x(), box.max().y(), box.max().z()}};
}

}  // namespace deltasplat
