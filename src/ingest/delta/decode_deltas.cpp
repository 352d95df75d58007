// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 6, read backwards: a slice is the sum of all changes since the last key slice.
#include "ingest/delta/decode_deltas.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <tuple>
#include <vector>

#include "deltasplat/error.h"
#include "ingest/codes/leaf_slices.h"
#include "ingest/delta/zigzag.h"
#include "memory.h"
#include "parallel.h"
#include "run_begins.h"

namespace deltasplat {
namespace {

using DeltaLeaf = openvdb::Int32Tree::LeafNodeType;
using Leaf = CodeTree::Leaf;

[[noreturn]] void fail(const std::string& where, const std::string& got,
                       const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(where, got, expected));
}

std::string placeText(const glm::ivec3& v) {
    return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) +
           ")";
}

// A block's place in (slice, u, v) order, divided by 8.
glm::ivec3 blockOf(const DeltaLeaf& leaf) {
    const openvdb::Coord origin = leaf.origin();
    return {origin.x() >> 3, origin.y() >> 3, origin.z() >> 3};
}

// The slots of one block and what became of them.
struct Block {
    glm::ivec3 position{0};
    std::unique_ptr<Leaf> codes;
    std::unique_ptr<Leaf> inactive;
    Slot tile = kEmptySlot;  // of the whole block, if there is no leaf
};

// One delta can stand for as many blocks as there are slices until the next key slice, so memory is
// asked for as it is needed.
constexpr std::size_t kAskEvery = 1024;
constexpr double kBlockBytes = sizeof(Block) + sizeof(Leaf) + Leaf::SIZE * sizeof(Code);

class Decoder {
  public:
    Decoder(const DeltaHeader& header, const std::string& where)
        : header_(header),
          where_(where),
          first_(toSliceOrder(header.box.min, header.sliceAxis)),
          last_(toSliceOrder(header.box.max, header.sliceAxis)),
          blocksPerSlab_(header.keyInterval / 8) {
        if (!header.restActive) return;
        restCode_ = header.book.codeOf(header.background);
    }

    int slabOf(int block) const { return (block - (first_.x >> 3)) / blocksPerSlab_; }
    int slabs() const { return header_.box.empty() ? 0 : slabOf(last_.x >> 3) + 1; }

    void requireInside(const DeltaLeaf& leaf) const {
        const glm::ivec3 block = blockOf(leaf);
        for (int axis = 0; axis < 3; ++axis) {
            if (!header_.box.empty() && block[axis] >= first_[axis] >> 3 &&
                block[axis] <= last_[axis] >> 3)
                continue;
            fail(where_, "deltas at " + placeText(8 * block), "deltas within the box " + boxText());
        }
    }

    // Decodes a column: the leaves of one slab with the same u and v, in the order of slices.
    std::vector<Block> decodeColumn(const DeltaLeaf* const* begin,
                                    const DeltaLeaf* const* end) const {
        std::vector<Block> blocks;
        std::array<Slot, 64> slots{};
        glm::ivec3 position = blockOf(**begin);
        const int slab = slabOf(position.x);
        const int lastBlock =
            std::min((last_.x >> 3), (first_.x >> 3) + (slab + 1) * blocksPerSlab_ - 1);
        for (; position.x <= lastBlock; ++position.x) {
            const bool changes = begin != end && blockOf(**begin).x == position.x;
            if (!changes && isEmpty(slots)) {
                if (begin == end) break;
                position.x = blockOf(**begin).x - 1;
                continue;
            }
            if (blocks.size() % kAskEvery == 0)
                requireMemory(where_, double(kAskEvery) * kBlockBytes);
            blocks.push_back(decodeBlock(position, changes ? *begin++ : nullptr, slots));
        }
        return blocks;
    }

    Code restCode() const { return restCode_; }

  private:
    static bool isEmpty(const std::array<Slot, 64>& slots) {
        return std::all_of(slots.begin(), slots.end(), [](Slot slot) { return slot == 0; });
    }

    std::string boxText() const { return placeText(first_) + " to " + placeText(last_); }

    // Adds one slice's deltas to the slots.
    void addSlice(const DeltaLeaf& leaf, int s, std::array<Slot, 64>& slots) const {
        std::uint64_t word = leaf.getValueMask().getWord<std::uint64_t>(openvdb::Index(s));
        const std::int32_t* deltas = leaf.buffer().data() + 64 * s;
        const auto slice = glm::ivec3(8 * blockOf(leaf)) + glm::ivec3(s, 0, 0);
        for (; word != 0; word &= word - 1) {
            const int n = std::countr_zero(word);
            const std::int32_t delta = header_.hasZigzag() ? fromZigzag(deltas[n]) : deltas[n];
            const std::int64_t slot = std::int64_t{slots[n]} + delta;
            const glm::ivec3 place = slice + glm::ivec3(0, n >> 3, n & 7);
            requireSlot(slot, place);
            slots[n] = Slot(slot);
        }
    }

    void requireSlot(std::int64_t slot, const glm::ivec3& place) const {
        const bool inside = glm::all(glm::greaterThanEqual(place, first_)) &&
                            glm::all(glm::lessThanEqual(place, last_));
        if (!inside)
            fail(where_, "a delta at " + placeText(place), "deltas within the box " + boxText());
        const bool code = slot >= 0 && slot <= header_.codeCount && isFiniteCode(slot);
        const bool value = slot >= kSlotCount && slot < header_.slotCount();
        if (code || value) return;
        fail(where_, "deltas that lead to " + std::to_string(slot) + " at " + placeText(place),
             "0.." + std::to_string(header_.codeCount) + ", the codes of its " +
                 header_.book.name() + " code book");
    }

    bool isFiniteCode(std::int64_t slot) const {
        if (header_.book.kind != CodeBook::Kind::kHalf || slot == 0) return true;
        return std::isfinite(header_.book.valueOf(Code(slot - 1)));
    }

    Block decodeBlock(const glm::ivec3& position, const DeltaLeaf* leaf,
                      std::array<Slot, 64>& slots) const {
        std::array<Slot, 512> block;
        for (int s = 0; s < 8; ++s) {
            if (leaf) addSlice(*leaf, s, slots);
            const bool exists = 8 * position.x + s <= last_.x;
            for (int n = 0; n < 64; ++n) block[64 * s + n] = exists ? slots[n] : kEmptySlot;
        }
        Block result;
        result.position = position;
        const bool uniform =
            std::all_of(block.begin(), block.end(), [&](Slot slot) { return slot == block[0]; });
        if (uniform) {
            result.tile = block[0];
        } else {
            makeLeaves(block, result);
        }
        return result;
    }

    void makeLeaves(const std::array<Slot, 512>& slots, Block& block) const {
        const openvdb::Coord origin = blockOrigin(block.position, header_.sliceAxis);
        block.codes = std::make_unique<Leaf>(origin, Code{0}, false);
        const Slot* slot = slots.data();
        forLeafVoxels(header_.sliceAxis, [&](const glm::ivec3& place, int n) {
            setVoxel(*slot++, 8 * block.position + place, openvdb::Index(n), origin, block);
        });
        if (block.codes->isEmpty()) block.codes.reset();
    }

    void setVoxel(Slot slot, const glm::ivec3& place, openvdb::Index n,
                  const openvdb::Coord& origin, Block& block) const {
        if (slot == kEmptySlot) {
            const bool rests = header_.restActive &&
                               glm::all(glm::greaterThanEqual(place, first_)) &&
                               glm::all(glm::lessThanEqual(place, last_));
            if (rests) block.codes->setValueOn(n, restCode_);
        } else if (slot < kSlotCount) {
            block.codes->setValueOn(n, Code(slot - 1));
        } else {
            if (!block.inactive) block.inactive = std::make_unique<Leaf>(origin, Code{0}, false);
            block.inactive->setValueOn(n, Code(slot - kSlotCount));
        }
    }

    const DeltaHeader& header_;
    const std::string& where_;
    glm::ivec3 first_;
    glm::ivec3 last_;
    int blocksPerSlab_;
    Code restCode_ = 0;
};

// Other programs may have made tiles of what this one writes as voxels.
void voxelizeTiles(openvdb::Int32Tree& tree, const std::string& where) {
    const double voxels = double(tree.activeVoxelCount()) - double(tree.activeLeafVoxelCount());
    if (voxels == 0) return;
    requireClaimedMemory(where, voxels * sizeof(Slot));
    tree.voxelizeActiveTiles();
}

// Returns the leaves, ordered by slab, u, v and slice.
std::vector<const DeltaLeaf*> orderedLeaves(const openvdb::Int32Tree& tree,
                                            const Decoder& decoder) {
    std::vector<const DeltaLeaf*> leaves;
    tree.getNodes(leaves);
    for (const DeltaLeaf* leaf : leaves) decoder.requireInside(*leaf);
    std::sort(leaves.begin(), leaves.end(), [&](const DeltaLeaf* a, const DeltaLeaf* b) {
        const glm::ivec3 p = blockOf(*a), q = blockOf(*b);
        return std::tuple(decoder.slabOf(p.x), p.y, p.z, p.x) <
               std::tuple(decoder.slabOf(q.x), q.y, q.z, q.x);
    });
    return leaves;
}

// Returns where in `leaves` each column begins, and at the end their number.
std::vector<std::size_t> columnsOf(const std::vector<const DeltaLeaf*>& leaves,
                                   const Decoder& decoder) {
    const auto column = [&](const DeltaLeaf* leaf) {
        const glm::ivec3 p = blockOf(*leaf);
        return glm::ivec3(decoder.slabOf(p.x), p.y, p.z);
    };
    return runBegins(
        leaves, [&](const DeltaLeaf* a, const DeltaLeaf* b) { return column(a) == column(b); });
}

void checkSlabs(const std::vector<const DeltaLeaf*>& leaves, const Decoder& decoder,
                const DeltaHeader& header, const std::string& where) {
    if (std::int64_t(header.slabDeltas.size()) != decoder.slabs()) {
        fail(where, std::to_string(header.slabDeltas.size()) + " slabs in \"delta_slab_deltas\"",
             std::to_string(decoder.slabs()));
    }
    std::vector<std::uint64_t> found(header.slabDeltas.size());
    for (const DeltaLeaf* leaf : leaves)
        found[std::size_t(decoder.slabOf(blockOf(*leaf).x))] += leaf->onVoxelCount();
    for (std::size_t slab = 0; slab < found.size(); ++slab) {
        if (found[slab] == header.slabDeltas[slab]) continue;
        fail(where, std::to_string(found[slab]) + " deltas in slab " + std::to_string(slab),
             std::to_string(header.slabDeltas[slab]) + ", as \"delta_slab_deltas\" says");
    }
}

// Puts blocks into the trees.
class Collector {
  public:
    Collector(const DeltaHeader& header, const std::string& where, DecodedDeltas& decoded)
        : header_(header),
          where_(where),
          codes_(decoded.codes->tree),
          inactive_(decoded.inactive->tree) {}

    void add(std::vector<Block>& blocks) {
        for (Block& block : blocks) {
            count(block);
            const openvdb::Coord corner = blockOrigin(block.position, header_.sliceAxis);
            askForNode(corner);
            if (block.codes) codes_.addLeaf(block.codes.release());
            if (block.inactive) inactive_.addLeaf(block.inactive.release());
            if (block.tile == kEmptySlot) continue;
            if (block.tile < kSlotCount) {
                codes_.addTile(1, corner, Code(block.tile - 1), true);
            } else {
                inactive_.addTile(1, corner, Code(block.tile - kSlotCount), true);
            }
        }
    }

  private:
    using Accessor = openvdb::tree::ValueAccessor<CodeTree::Tree>;
    using Node = CodeTree::Tree::RootNodeType::ChildNodeType::ChildNodeType;

    // What is more than the file says is not waited for.
    void count(const Block& block) {
        if (header_.restActive) return;
        if (block.codes) active_ += block.codes->onVoxelCount();
        if (block.tile != kEmptySlot && block.tile < kSlotCount) active_ += Leaf::SIZE;
        if (active_ <= header_.active) return;
        fail(where_, "at least " + std::to_string(active_) + " active voxels",
             std::to_string(header_.active) + ", as \"delta_active\" says");
    }

    // Tiles are small, but not the nodes that they are in.
    void askForNode(const openvdb::Coord& corner) {
        constexpr int kAtOnce = 64;
        if (codes_.probeConstNode<Node>(corner)) return;
        if (newNodes_++ % kAtOnce == 0) requireMemory(where_, 2.0 * kAtOnce * sizeof(Node));
    }

    const DeltaHeader& header_;
    const std::string& where_;
    Accessor codes_;
    Accessor inactive_;
    std::uint64_t active_ = 0;
    int newNodes_ = 0;
};

void fillRest(const DeltaHeader& header, Code restCode, const std::string& where,
              CodeTree::Tree& tree) {
    const glm::ivec3 low = header.box.min, high = header.box.max;
    // A filled box has leaves at its faces and, within, a root tile for each 4096^3 voxels.
    const glm::dvec3 dims(header.box.dims());
    const double faces = 2 * (dims.x * dims.y + dims.y * dims.z + dims.z * dims.x);
    requireClaimedMemory(where, faces / 64 * (sizeof(Leaf) + Leaf::SIZE * sizeof(Code)) +
                                    double(header.box.voxels()) / 0x1p36 * 100);
    tree.fill({{low.x, low.y, low.z}, {high.x, high.y, high.z}}, restCode, true);
}

}  // namespace

DecodedDeltas decodeDeltas(openvdb::Int32Grid& grid, const DeltaHeader& header,
                           const std::string& where, const Listener& listener) {
    if (grid.background() != 0) fail(where, "background " + std::to_string(grid.background()), "0");
    const Decoder decoder(header, where);
    voxelizeTiles(grid.tree(), where);
    const std::vector<const DeltaLeaf*> leaves = orderedLeaves(grid.tree(), decoder);
    checkSlabs(leaves, decoder, header, where);

    DecodedDeltas decoded;
    if (header.restActive && !header.box.empty())
        fillRest(header, decoder.restCode(), where, decoded.codes->tree);
    const std::vector<std::size_t> columns = columnsOf(leaves, decoder);
    Collector collector(header, where, decoded);
    // In portions, so that memory is asked for as it is needed.
    constexpr std::size_t kPortion = 2048;
    for (std::size_t begin = 0; begin + 1 < columns.size(); begin += kPortion) {
        const std::size_t count = std::min(kPortion, columns.size() - 1 - begin);
        const int blocksPerColumn = header.keyInterval / 8;
        requireClaimedMemory(where, double(count) * blocksPerColumn * sizeof(Block));
        std::vector<std::vector<Block>> blocks(count);
        parallelForChunks(count, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                blocks[i] = decoder.decodeColumn(&leaves[columns[begin + i]],
                                                 leaves.data() + columns[begin + i + 1]);
            }
        });
        for (auto& column : blocks) collector.add(column);
        listener.report(double(begin + count) / double(columns.size()));
    }
    return decoded;
}

}  // namespace deltasplat
