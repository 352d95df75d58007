// SPDX-License-Identifier: Apache-2.0
#include "ingest/delta/word_grid.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include "deltasplat/error.h"
#include "ingest/grids/leaf_bytes.h"
#include "memory.h"

namespace deltasplat {
namespace {

using Tree = openvdb::Int64Grid::TreeType;
using Leaf = Tree::LeafNodeType;
constexpr std::size_t kLeafWords = Leaf::NUM_VALUES;

// Whether the first `count` voxels of a leaf are active, and no others.
bool holdsFirst(const Leaf& leaf, std::size_t count) {
    return leaf.onVoxelCount() == count &&
           (count == kLeafWords || leaf.getValueMask().findFirstOff() == count);
}

}  // namespace

openvdb::Coord wordLeafOrigin(std::size_t leaf) {
    const std::size_t node = leaf >> 12;  // of 16^3 leaves, of which 32^3 make a node themselves
    return {int(8 * (leaf >> 8 & 15) + 128 * (node >> 10)),
            int(8 * (leaf >> 4 & 15) + 128 * (node >> 5 & 31)),
            int(8 * (leaf & 15) + 128 * (node & 31))};
}

openvdb::Int64Grid::Ptr gridOfWords(const std::vector<std::uint64_t>& words) {
    auto grid = openvdb::Int64Grid::create(0);
    openvdb::tree::ValueAccessor<Tree> accessor(grid->tree());
    for (std::size_t begin = 0; begin < words.size(); begin += kLeafWords) {
        const std::size_t count = std::min(kLeafWords, words.size() - begin);
        auto leaf = std::make_unique<Leaf>(wordLeafOrigin(begin / kLeafWords), 0, false);
        std::memcpy(leaf->buffer().data(), &words[begin], count * sizeof words[0]);
        for (std::size_t i = 0; i < count; ++i) leaf->setValueOn(openvdb::Index(i));
        accessor.addLeaf(leaf.release());
    }
    return grid;
}

std::vector<std::uint64_t> wordsOfGrid(const openvdb::Int64Grid& grid, std::size_t padding,
                                       const std::string& where) {
    const auto count = std::size_t(grid.activeVoxelCount());
    requireClaimedMemory(where, double(count) * sizeof(std::uint64_t));
    std::vector<std::uint64_t> words(count + padding);
    const auto accessor = grid.getConstAccessor();
    for (std::size_t begin = 0; begin < count; begin += kLeafWords) {
        const std::size_t size = std::min(kLeafWords, count - begin);
        const openvdb::Coord origin = wordLeafOrigin(begin / kLeafWords);
        const Leaf* const leaf = accessor.probeConstLeaf(origin);
        if (leaf && holdsFirst(*leaf, size)) {
            std::memcpy(&words[begin], leaf->buffer().data(), size * sizeof words[0]);
        } else if (!leaf && size == kLeafWords && accessor.isValueOn(origin)) {
            // Another program has made a tile of equal words.
            std::fill_n(&words[begin], size, std::uint64_t(accessor.getValue(origin)));
        } else {
            throw Error(
                ErrorCode::kInput,
                gotExpected(where,
                            "a gap in its words in or behind number " + std::to_string(begin),
                            std::to_string(count) + ", one behind the other"));
        }
    }
    return words;
}

}  // namespace deltasplat
