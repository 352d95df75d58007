// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/delta_stream.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/slot.h"
#include "formats/delta/delta_columns.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/part_walker.h"
#include "formats/delta/stream_index.h"
#include "formats/delta/word_tree.h"
#include "volume/leaf_bytes.h"

namespace deltasplat {
namespace {

template <typename Leaf>
void fillLeaf(const BlockDeltasOf<typename Leaf::ValueType>& deltas, Leaf& leaf) {
    typename Leaf::NodeMaskType mask;
    auto* const values = leaf.buffer().data();
    const auto* next = deltas.numbers;
    for (openvdb::Index s = 0; s < 8; ++s) {
        for (std::uint64_t given = deltas.given[s]; given != 0; given &= given - 1)
            values[64 * s + openvdb::Index(std::countr_zero(given))] = *next++;
        mask.template getWord<std::uint64_t>(s) = deltas.changed[s];
    }
    leaf.setValueMask(mask);
}

class StreamUnpacker {
  public:
    StreamUnpacker(const openvdb::Int64Tree& tree, const DeltaHeader& header,
                   const std::string& where)
        : header_(header), where_(where), words_(wordsOfTree(tree, kStreamPadding, where)) {
        const std::size_t count = words_.size() - kStreamPadding;
        if (count > 0) index_ = readStreamIndex(words_.data(), count, header, where);
    }

    const StreamIndex& index() const { return index_; }

    template <typename Tree>
    std::shared_ptr<Tree> takeDeltas(const Listener& listener) const;

  private:
    template <typename Leaf>
    using Leaves = std::vector<std::unique_ptr<Leaf>>;

    template <typename Leaf>
    Leaves<Leaf> takePart(const StreamPart& part) const;

    const DeltaHeader& header_;
    const std::string& where_;
    std::vector<std::uint64_t> words_;
    StreamIndex index_;
};

template <typename Leaf>
StreamUnpacker::Leaves<Leaf> StreamUnpacker::takePart(const StreamPart& part) const {
    PartWalker<typename Leaf::ValueType> walker(words_.data(), header_);
    const auto damaged = [&] {
        const glm::ivec3 place = 8 * glm::ivec3(walker.block(), part.first.y, part.first.z);
        throw Error(ErrorCode::kInput, where_, "a damaged stream at " + placeText(place),
                    "blocks one behind the other");
    };
    if (!walker.start(part)) damaged();
    Leaves<Leaf> leaves;
    while (!walker.isDone()) {
        const openvdb::Coord origin(8 * walker.block(), 8 * part.first.y, 8 * part.first.z);
        const auto* const deltas = walker.take();
        if (!deltas) damaged();
        leaves.push_back(std::make_unique<Leaf>(origin, 0, false));
        fillLeaf(*deltas, *leaves.back());
    }
    return leaves;
}

template <typename Tree>
std::shared_ptr<Tree> StreamUnpacker::takeDeltas(const Listener& listener) const {
    using Leaf = typename Tree::LeafNodeType;
    const std::vector<StreamPart>& parts = index_.parts;
    requireMemory(where_, double(countBlocks(words_.data(), parts)) * leafBytes<Leaf>());
    auto tree = std::make_shared<Tree>(0);
    openvdb::tree::ValueAccessor<Tree> accessor(*tree);
    // In portions, so that what is in no tree yet is little.
    constexpr std::size_t kPortion = 2048;
    for (std::size_t begin = 0; begin < parts.size(); begin += kPortion) {
        const std::size_t count = std::min(kPortion, parts.size() - begin);
        std::vector<Leaves<Leaf>> taken(count);
        parallelForChunks(count, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) taken[i] = takePart<Leaf>(parts[begin + i]);
        });
        for (Leaves<Leaf>& part : taken) {
            for (auto& leaf : part) accessor.addLeaf(leaf.release());
        }
        listener.report(double(begin + count) / double(parts.size()));
    }
    return tree;
}

}  // namespace

UnpackedDeltas unpackDeltas(const TreeGrid& grid, const DeltaHeader& header,
                            const std::string& where, const Listener& listener) {
    const StreamUnpacker unpacker(*grid.as<openvdb::Int64Tree>(), header, where);
    UnpackedDeltas deltas{{nullptr, grid.metadata, grid.map}, codesInUse(unpacker.index(), header)};
    if (header.isWide()) {
        deltas.grid.tree = unpacker.takeDeltas<openvdb::Int64Tree>(listener);
    } else {
        deltas.grid.tree = unpacker.takeDeltas<openvdb::Int32Tree>(listener);
    }
    return deltas;
}

int deltaWidth(const DeltaHeader& header) {
    if (header.exact) return *header.exact == ExactValues::kFloat32 ? 32 : 64;
    const std::size_t inactive = header.inactiveValues.size();
    const std::size_t largest =
        inactive > 0 ? std::size_t(kCodeCount) + inactive : std::size_t(header.codeCount);
    return int(std::bit_width(2 * largest));
}

}  // namespace deltasplat
