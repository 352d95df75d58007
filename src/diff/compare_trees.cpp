// SPDX-License-Identifier: Apache-2.0
#include "diff/compare_trees.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "base/parallel.h"

namespace deltasplat {
namespace {

using openvdb::Coord;

// Edges of what one entry of a tree's root, of the nodes below and of those below them stands for.
constexpr int kRegion = 4096;
constexpr int kTile = 128;
constexpr int kBlock = 8;

constexpr std::uint64_t cube(int edge) {
    return std::uint64_t(edge) * std::uint64_t(edge) * std::uint64_t(edge);
}

// Both volumes on one thread.
class ReaderPair {
  public:
    ReaderPair(const VoxelSource& a, const VoxelSource& b, const ErrorTerms& terms)
        : a_(a.makeReader()), b_(b.makeReader()), terms_(terms) {}

    // Adds the region if both volumes are uniform over it: if their nodes there are at most this
    // deep.
    bool addIfUniform(const Coord& first, int depth, int edge, ErrorSums& sums) {
        if (a_->depthAt(first) > depth || b_->depthAt(first) > depth) return false;
        sums.addTile(a_->sampleAt(first), b_->sampleAt(first), first, cube(edge), terms_);
        return true;
    }

    // Adds the 8x8x8 voxels at `origin`.
    void addBlock(const Coord& origin, ErrorSums& sums) {
        const bool leafA = a_->readLeaf(origin, blockA_);
        const bool leafB = b_->readLeaf(origin, blockB_);
        if (!leafA && !leafB) {
            sums.addTile(a_->sampleAt(origin), b_->sampleAt(origin), origin, cube(kBlock), terms_);
            return;
        }
        if (!leafA) blockA_.fill(a_->sampleAt(origin), terms_.wide);
        if (!leafB) blockB_.fill(b_->sampleAt(origin), terms_.wide);
        sums.addBlock(blockA_, blockB_, origin, terms_);
    }

  private:
    std::unique_ptr<VoxelReader> a_;
    std::unique_ptr<VoxelReader> b_;
    const ErrorTerms& terms_;
    BlockSamples blockA_;
    BlockSamples blockB_;
};

// Calls visit(first) for every cube of the given edge in the box of this size at `origin`, in
// memory order.
template <typename Visit>
void forEachCube(const Coord& origin, const Coord& size, int edge, const Visit& visit) {
    for (int x = 0; x < size.x(); x += edge) {
        for (int y = 0; y < size.y(); y += edge) {
            for (int z = 0; z < size.z(); z += edge) visit(origin.offsetBy(x, y, z));
        }
    }
}

std::vector<Coord> regionsOf(const VoxelSource& a, const VoxelSource& b) {
    std::vector<Coord> regions = a.regions();
    regions.insert(regions.end(), b.regions().begin(), b.regions().end());
    std::sort(regions.begin(), regions.end());
    regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
    return regions;
}

// Pieces of 8x128x128 voxels: a layer of blocks of one node, enough for one thread at a time.
const Coord kPiece{kBlock, kTile, kTile};

// Adds what is uniform on a large scale, and returns the first voxels of all other pieces.
std::vector<Coord> addLargeTiles(const VoxelSource& a, const VoxelSource& b, ReaderPair& readers,
                                 ErrorSums& sums) {
    std::vector<Coord> pieces;
    for (const Coord& region : regionsOf(a, b)) {
        if (readers.addIfUniform(region, 0, kRegion, sums)) continue;
        forEachCube(region, Coord(kRegion), kTile, [&](const Coord& tile) {
            if (readers.addIfUniform(tile, 1, kTile, sums)) return;
            for (int x = 0; x < kTile; x += kBlock) pieces.push_back(tile.offsetBy(x, 0, 0));
        });
    }
    return pieces;
}

}  // namespace

ErrorSums compareTrees(const VoxelSource& a, const VoxelSource& b, const ErrorTerms& terms,
                       const Listener& listener) {
    ErrorSums whole;
    ReaderPair readers(a, b, terms);
    const std::vector<Coord> pieces = addLargeTiles(a, b, readers, whole);

    // In batches, so that few sums are in memory and the listener is heard.
    constexpr std::size_t kBatch = 512;
    for (std::size_t begin = 0; begin < pieces.size(); begin += kBatch) {
        listener.report(double(begin) / double(pieces.size()));
        std::vector<ErrorSums> sums(std::min(kBatch, pieces.size() - begin));
        parallelFor(sums.size(), [&](std::size_t i) {
            ReaderPair own(a, b, terms);
            forEachCube(pieces[begin + i], kPiece, kBlock,
                        [&](const Coord& block) { own.addBlock(block, sums[i]); });
        });
        for (const ErrorSums& part : sums) whole.append(part);
    }
    listener.report(1);
    return whole;
}

}  // namespace deltasplat
