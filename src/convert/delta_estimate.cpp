// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/delta/delta_estimate.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "convert/half_exact.h"
#include "convert/take_deltas.h"
#include "convert/volume_grid.h"
#include "default_floats.h"
#include "delta/stream_writer.h"
#include "deltasplat/error.h"
#include "ingest/codes/code_tree.h"
#include "ingest/delta/decode_blocks.h"
#include "ingest/delta/delta_format.h"
#include "ingest/delta/word_tree.h"
#include "ingest/grids/grid_metadata.h"
#include "ingest/grids/source_grid.h"
#include "ingest/grids/tree_types.h"
#include "ingest/vdb/vdb_transform.h"
#include "vdb/write_vdb.h"

namespace deltasplat {
namespace {

// So many blocks are written, or up to twice as many.
constexpr std::size_t kBlocks = 1000;

// Bytes of inner nodes in a file: two masks each, and values that are all alike.
constexpr double kLowerNode = 2 * 512 + 10;
constexpr double kUpperNode = 2 * 4096 + 10;

constexpr double kLeafWords = 512;

// Which columns of blocks along an axis are packed: every n-th of a row, in the next row shifted.
struct Chosen {
    int sliceAxis;
    std::size_t every;

    bool operator()(const openvdb::Coord& origin) const {
        const glm::ivec3 place =
            toSliceOrder(glm::ivec3(origin.x(), origin.y(), origin.z()), sliceAxis);
        // Modulo 2^32, so that negative places are places as well.
        const auto shift = std::uint32_t(every * 5 / 13 + 1);
        const auto number = std::uint32_t(place.y >> 3) * shift + std::uint32_t(place.z >> 3);
        return number % every == 0;
    }
};

// Adds the chosen blocks of the values of uniform regions. Returns whether all regions are small.
template <typename Tree>
bool copyTiles(const Tree& tree, const Chosen& chosen, Tree& sample) {
    auto tile = tree.cbeginValueOn();
    tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        const openvdb::CoordBBox box = tile.getBoundingBox();
        if (box.dim().x() > 128) return false;
        for (int x = box.min().x(); x <= box.max().x(); x += 8) {
            for (int y = box.min().y(); y <= box.max().y(); y += 8) {
                for (int z = box.min().z(); z <= box.max().z(); z += 8) {
                    if (chosen({x, y, z})) sample.addTile(1, {x, y, z}, *tile, true);
                }
            }
        }
    }
    return true;
}

template <typename Tree>
bool copyChosen(const Tree& tree, const Chosen& chosen, Tree& sample) {
    using Leaf = typename Tree::LeafNodeType;
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
        if (chosen(leaf->origin())) sample.addLeaf(new Leaf(*leaf));
    }
    return copyTiles(tree, chosen, sample);
}

// Returns a volume with the chosen blocks of another; empty if that has too large uniform regions.
std::optional<Volume> sampleOf(const Volume& volume, const Chosen& chosen) {
    Volume sample = volume;
    const auto codes = std::make_shared<CodeTree>();
    bool fits = copyChosen(volume.codes->tree(), chosen, codes->tree());
    sample.codes = codes;
    if (volume.source) {
        TreeGrid part{nullptr, {}, volume.source->grid.map};
        volume.source->grid.apply<ScalarTrees>([&](const auto& tree) {
            const auto some = std::make_shared<std::decay_t<decltype(tree)>>(tree.background());
            fits = copyChosen(tree, chosen, *some) && fits;
            part.tree = some;
        });
        sample.source = std::make_shared<const SourceGrid>(
            SourceGrid{std::move(part), volume.source->fileMetadata});
    }
    if (!fits) return {};
    return sample;
}

double bytesOf(const TreeGrid& grid) {
    return double(writtenBytes(writtenGrid(grid)));
}

double nodeBytes(const openvdb::TreeBase& tree) {
    const auto counts = tree.nodeCount();  // leaves first, the root last
    return kLowerNode * counts[1] + kUpperNode * counts[2];
}

// Returns the bytes of a grid's metadata and nodes, and of all the leaves that its own stand for.
// @param leaves  how many times its own
// @param nodes  bytes of all nodes
double scaledBytes(const TreeGrid& grid, double leaves, double nodes) {
    TreeGrid empty{nullptr, grid.metadata, grid.map};
    grid.apply<ScalarTrees>([&](const auto& tree) {
        empty.tree = std::make_shared<std::decay_t<decltype(tree)>>(tree.background());
    });
    const double header = bytesOf(empty);
    const double own = bytesOf(grid) - header - nodeBytes(*grid.tree);
    return header + nodes + leaves * own;
}

double plainBytes(TreeGrid sample, double share, double nodes) {
    sample.metadata.insert(openvdb::GridBase::META_SAVE_HALF_FLOAT, survivesHalf(sample));
    return scaledBytes(sample, 1 / share, nodes);
}

// Returns the grid of a delta file, but for its place.
TreeGrid deltaGrid(std::shared_ptr<openvdb::TreeBase> tree, const DeltaHeader& header) {
    TreeGrid grid{std::move(tree), {}, makeMap(glm::dmat4(1))};
    putDeltaHeader(header, grid.metadata);
    return grid;
}

double packedBytes(const TakenDeltas& sample, double share) {
    const std::vector<std::uint64_t> words = streamOf(*sample.deltas, sample.header);
    const TreeGrid packed = deltaGrid(treeOfWords(words), sample.header);
    const double leaves = double(words.size()) / share / kLeafWords;
    const double nodes = words.empty() ? 0 : kUpperNode + kLowerNode * (1 + leaves / 4096);
    return scaledBytes(packed, 1 / share, nodes);
}

std::optional<DeltaEstimate> estimateFrom(const Volume& volume, int sliceAxis) {
    const std::size_t blocks = volume.codes->tree().leafCount();
    const Chosen chosen{sliceAxis, std::max<std::size_t>(1, blocks / kBlocks)};
    std::optional<Volume> sample = sampleOf(volume, chosen);
    if (!sample) return {};
    const std::size_t sampled = sample->codes->tree().leafCount();
    if (sampled == 0 && blocks > 0) return {};
    DeltaEstimate estimate;
    const double share = blocks == 0 ? 1 : double(sampled) / double(blocks);
    estimate.sampled = share;
    const double nodes = nodeBytes(volume.codes->tree());
    const TreeGrid plain = gridOf(*sample);
    estimate.plainBytes = plainBytes(plain, share, nodes);
    // What a table is worth is known of values by their own bits.
    if (!sample->source && sample->hasBackground)
        sample->source = std::make_shared<const SourceGrid>(SourceGrid{plain});
    DeltaFileOptions options;
    options.sliceAxis = sliceAxis;
    options.pack = false;
    const TakenDeltas voxels = takeDeltas(*sample, options);
    // Of what inactive voxels hold a sample says little.
    if (voxels.inactive.numbers || voxels.inactive.tooMany) return {};
    estimate.voxelBytes = scaledBytes(deltaGrid(voxels.deltas, voxels.header), 1 / share,
                                      share == 1 ? nodeBytes(*voxels.deltas) : nodes);
    estimate.readsByBlocks =
        mayDecodeBlocks(voxels.header) && volume.gridClass != kLevelSetClass;  // made fog first
    options.pack = true;
    estimate.deltaBytes = packedBytes(takeDeltas(*sample, options), share);
    return estimate;
}

}  // namespace

std::optional<DeltaEstimate> estimateDeltaFile(const Volume& volume, int sliceAxis) {
    const DefaultFloats floats;
    if (volume.empty() || (!volume.source && !volume.codeBook.isExact())) return {};
    try {
        return estimateFrom(volume, sliceAxis);
    } catch (const Error&) {
        return {};  // too little memory, or a place that OpenVDB has no transform for
    }
}

}  // namespace deltasplat
