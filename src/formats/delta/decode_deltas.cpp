// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 6, read backwards: a slice is the sum of all changes since the last key slice.
#include "formats/delta/decode_deltas.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/refuse.h"
#include "base/sorting.h"
#include "deltasplat/error.h"
#include "formats/delta/delta_columns.h"
#include "formats/delta/exact_slots.h"
#include "formats/delta/restored_grid.h"
#include "volume/code_math.h"
#include "volume/leaf_slices.h"
#include "volume/value_cast.h"

namespace deltasplat {
namespace {

// Returns a block's place in (slice, u, v) order, divided by 8.
template <typename DeltaLeaf>
glm::ivec3 blockOf(const DeltaLeaf& leaf) {
    const openvdb::Coord origin = leaf.origin();
    return {origin.x() >> 3, origin.y() >> 3, origin.z() >> 3};
}

// Arithmetic and meaning of slots for codes.
class CodeWords {
  public:
    using Slot = std::uint32_t;
    using DeltaTree = openvdb::Int32Tree;
    using Tree = CodeTree::Tree;

    explicit CodeWords(const DeltaHeader& header)
        : header_(header),
          codeCount_(Slot(header.codeCount)),
          isHalf_(header.book.kind == CodeBook::Kind::kHalf) {
        if (header.restActive) rest_ = header.book.codeOf(header.background);
    }

    Slot sum(Slot slot, std::int32_t delta) const { return slot + Slot(fromZigzag(delta)); }
    bool isValue(Slot slot) const {
        return slot - 1 < codeCount_ && (!isHalf_ || isFiniteCode(slot));
    }
    Code valueOf(Slot slot) const { return Code(slot - 1); }
    Code rest() const { return rest_; }
    Code inactiveValue() const { return 0; }
    static Slot firstInactive() { return Slot(kSlotCount); }
    std::string textOf(Slot slot) const { return std::to_string(std::int32_t(slot)); }
    std::string expected() const {
        return "0.." + std::to_string(header_.codeCount) + ", the codes of its " +
               header_.book.name() + " code book";
    }

  private:
    bool isFiniteCode(Slot slot) const {
        return std::isfinite(header_.book.valueOf(valueOf(slot)));
    }

    const DeltaHeader& header_;
    Slot codeCount_;
    bool isHalf_;
    Code rest_ = 0;
};

// The same for slots made of the values' own bits.
template <typename T>
class ExactWords {
  public:
    using Slots = ExactSlots<T>;
    using Slot = typename Slots::Slot;
    using DeltaTree = typename Slots::DeltaTree;
    using Tree = typename openvdb::tree::Tree4<T, 5, 4, 3>::Type;

    explicit ExactWords(const DeltaHeader& header)
        : rest_(valueAs<T>(header.background)), background_(header.restActive ? T{} : rest_) {}

    Slot sum(Slot slot, typename Slots::Delta delta) const {
        return slot + Slot(fromZigzag(delta));
    }
    bool isValue(Slot slot) const { return Slots::isValue(slot); }
    T valueOf(Slot slot) const { return Slots::valueOf(slot); }
    T rest() const { return rest_; }
    T inactiveValue() const { return background_; }
    static Slot firstInactive() { return Slots::firstInactive(); }
    std::string textOf(Slot slot) const { return std::to_string(slot); }
    std::string expected() const {
        return "0 or " + std::to_string(Slots::lowest()) + ".." + std::to_string(Slots::highest());
    }

  private:
    T rest_;
    T background_;
};

template <typename Words>
struct Block {
    using Leaf = typename Words::Tree::LeafNodeType;
    glm::ivec3 position{0};
    std::unique_ptr<Leaf> values;
    std::unique_ptr<CodeTree::Leaf> inactive;
    typename Words::Slot tile = 0;  // of the whole block, if there is no leaf
};

// Blocks per request for memory: one delta can stand for all blocks until the next key slice.
constexpr std::size_t kAskEvery = 1024;

template <typename Words>
class Decoder {
  public:
    using Slot = typename Words::Slot;
    using DeltaLeaf = typename Words::DeltaTree::LeafNodeType;
    using Leaf = typename Words::Tree::LeafNodeType;

    Decoder(const DeltaHeader& header, const Words& words, const std::string& where)
        : header_(header),
          words_(words),
          where_(where),
          first_(toSliceOrder(header.box.min, header.sliceAxis)),
          last_(toSliceOrder(header.box.max, header.sliceAxis)),
          blocksPerSlab_(header.keyInterval / 8),
          inactiveValues_(Slot(header.inactiveValues.size())) {}

    int slabOf(int block) const { return (block - (first_.x >> 3)) / blocksPerSlab_; }
    int slabs() const { return header_.box.empty() ? 0 : slabOf(last_.x >> 3) + 1; }

    void requireInside(const DeltaLeaf& leaf) const {
        const glm::ivec3 block = blockOf(leaf);
        for (int axis = 0; axis < 3; ++axis) {
            if (!header_.box.empty() && block[axis] >= first_[axis] >> 3 &&
                block[axis] <= last_[axis] >> 3)
                continue;
            refuseInput(where_, "deltas at " + placeText(8 * block),
                        "deltas within the box " + boxText());
        }
    }

    // Decodes a column: leaves of one slab with the same u and v, in the order of slices.
    std::vector<Block<Words>> decodeColumn(const DeltaLeaf* const* begin,
                                           const DeltaLeaf* const* end) const {
        std::vector<Block<Words>> blocks;
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
                requireMemory(where_, kAskEvery * (sizeof(Block<Words>) + leafBytes<Leaf>()));
            blocks.push_back(decodeBlock(position, changes ? *begin++ : nullptr, slots));
        }
        return blocks;
    }

  private:
    static bool isEmpty(const std::array<Slot, 64>& slots) {
        return std::all_of(slots.begin(), slots.end(), [](Slot slot) { return slot == 0; });
    }

    std::string boxText() const { return placeText(first_) + " to " + placeText(last_); }

    bool isInside(const glm::ivec3& place) const {
        return place.x >= first_.x && place.x <= last_.x && place.y >= first_.y &&
               place.y <= last_.y && place.z >= first_.z && place.z <= last_.z;
    }

    void addSlice(const DeltaLeaf& leaf, int s, std::array<Slot, 64>& slots) const {
        std::uint64_t word = leaf.getValueMask().template getWord<std::uint64_t>(openvdb::Index(s));
        const auto* deltas = leaf.buffer().data() + 64 * s;
        const auto slice = glm::ivec3(8 * blockOf(leaf)) + glm::ivec3(s, 0, 0);
        for (; word != 0; word &= word - 1) {
            const int n = std::countr_zero(word);
            slots[n] = words_.sum(slots[n], deltas[n]);
            requireSlot(slots[n], slice + glm::ivec3(0, n >> 3, n & 7));
        }
    }

    void requireSlot(Slot slot, const glm::ivec3& place) const {
        if (!isInside(place))
            refuseInput(where_, "a delta at " + placeText(place),
                        "deltas within the box " + boxText());
        const bool isNumber = Slot(slot - Words::firstInactive()) < inactiveValues_;
        if (slot == 0 || words_.isValue(slot) || isNumber) return;
        refuseInput(where_,
                    "deltas that lead to " + words_.textOf(slot) + " at " + placeText(place),
                    words_.expected());
    }

    Block<Words> decodeBlock(const glm::ivec3& position, const DeltaLeaf* leaf,
                             std::array<Slot, 64>& slots) const {
        std::array<Slot, 512> block;
        for (int s = 0; s < 8; ++s) {
            if (leaf) addSlice(*leaf, s, slots);
            const bool exists = 8 * position.x + s <= last_.x;
            for (int n = 0; n < 64; ++n) block[64 * s + n] = exists ? slots[n] : Slot{0};
        }
        Block<Words> result;
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

    void makeLeaves(const std::array<Slot, 512>& slots, Block<Words>& block) const {
        const openvdb::Coord origin = blockOrigin(block.position, header_.sliceAxis);
        block.values = std::make_unique<Leaf>(origin, words_.inactiveValue(), false);
        const Slot* slot = slots.data();
        forLeafVoxels(header_.sliceAxis, [&](const glm::ivec3& place, int n) {
            setVoxel(*slot++, 8 * block.position + place, openvdb::Index(n), origin, block);
        });
        if (block.values->isEmpty()) block.values.reset();
    }

    void setVoxel(Slot slot, const glm::ivec3& place, openvdb::Index n,
                  const openvdb::Coord& origin, Block<Words>& block) const {
        if (slot == 0) {
            if (header_.restActive && isInside(place)) block.values->setValueOn(n, words_.rest());
        } else if (slot < Words::firstInactive()) {
            block.values->setValueOn(n, words_.valueOf(slot));
        } else {
            if (!block.inactive)
                block.inactive = std::make_unique<CodeTree::Leaf>(origin, Code{0}, false);
            block.inactive->setValueOn(n, Code(slot - Words::firstInactive()));
        }
    }

    const DeltaHeader& header_;
    const Words& words_;
    const std::string& where_;
    glm::ivec3 first_;
    glm::ivec3 last_;
    int blocksPerSlab_;
    Slot inactiveValues_;  // their number
};

// Other programs may have made tiles of voxels.
template <typename Tree>
void voxelizeTiles(Tree& tree, const std::string& where) {
    const double voxels = double(tree.activeVoxelCount()) - double(tree.activeLeafVoxelCount());
    if (voxels == 0) return;
    requireClaimedMemory(where, voxels * sizeof(typename Tree::ValueType));
    tree.voxelizeActiveTiles();
}

// Returns the leaves by slab, u, v and slice.
template <typename Tree, typename Words>
std::vector<const typename Tree::LeafNodeType*> orderedLeaves(const Tree& tree,
                                                              const Decoder<Words>& decoder) {
    std::vector<const typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    for (const auto* leaf : leaves) decoder.requireInside(*leaf);
    std::sort(leaves.begin(), leaves.end(), [&](const auto* a, const auto* b) {
        const glm::ivec3 p = blockOf(*a), q = blockOf(*b);
        return std::tuple(decoder.slabOf(p.x), p.y, p.z, p.x) <
               std::tuple(decoder.slabOf(q.x), q.y, q.z, q.x);
    });
    return leaves;
}

// Returns the first index of each column in `leaves`, and their number at the end.
template <typename DeltaLeaf, typename Words>
std::vector<std::size_t> columnsOf(const std::vector<const DeltaLeaf*>& leaves,
                                   const Decoder<Words>& decoder) {
    const auto column = [&](const DeltaLeaf* leaf) {
        const glm::ivec3 p = blockOf(*leaf);
        return glm::ivec3(decoder.slabOf(p.x), p.y, p.z);
    };
    return runBegins(
        leaves, [&](const DeltaLeaf* a, const DeltaLeaf* b) { return column(a) == column(b); });
}

template <typename DeltaLeaf, typename Words>
void checkSlabs(const std::vector<const DeltaLeaf*>& leaves, const Decoder<Words>& decoder,
                const DeltaHeader& header, const std::string& where) {
    if (std::int64_t(header.slabDeltas.size()) != decoder.slabs()) {
        refuseInput(where,
                    std::to_string(header.slabDeltas.size()) + " slabs in \"delta_slab_deltas\"",
                    std::to_string(decoder.slabs()));
    }
    std::vector<std::uint64_t> found(header.slabDeltas.size());
    for (const DeltaLeaf* leaf : leaves)
        found[std::size_t(decoder.slabOf(blockOf(*leaf).x))] += leaf->onVoxelCount();
    for (std::size_t slab = 0; slab < found.size(); ++slab) {
        if (found[slab] == header.slabDeltas[slab]) continue;
        refuseInput(where, std::to_string(found[slab]) + " deltas in slab " + std::to_string(slab),
                    std::to_string(header.slabDeltas[slab]) + ", as \"delta_slab_deltas\" says");
    }
}

template <typename Words>
class Collector {
  public:
    using Tree = typename Words::Tree;

    Collector(const DeltaHeader& header, const Words& words, const std::string& where, Tree& values,
              CodeTree::Tree& inactive)
        : header_(header), words_(words), where_(where), values_(values), inactive_(inactive) {}

    void add(std::vector<Block<Words>>& blocks) {
        for (Block<Words>& block : blocks) {
            count(block);
            const openvdb::Coord corner = blockOrigin(block.position, header_.sliceAxis);
            askForNode(corner);
            if (block.values) values_.addLeaf(block.values.release());
            if (block.inactive) inactive_.addLeaf(block.inactive.release());
            if (block.tile == 0) continue;
            if (block.tile < Words::firstInactive()) {
                values_.addTile(1, corner, words_.valueOf(block.tile), true);
            } else {
                inactive_.addTile(1, corner, Code(block.tile - Words::firstInactive()), true);
            }
        }
    }

  private:
    using Node = typename Tree::RootNodeType::ChildNodeType::ChildNodeType;

    // Stops as soon as the header's voxel count is exceeded.
    void count(const Block<Words>& block) {
        if (header_.restActive) return;
        if (block.values) active_ += block.values->onVoxelCount();
        if (block.tile != 0 && block.tile < Words::firstInactive())
            active_ += Tree::LeafNodeType::SIZE;
        if (active_ <= header_.active) return;
        refuseInput(where_, "at least " + std::to_string(active_) + " active voxels",
                    std::to_string(header_.active) + ", as \"delta_active\" says");
    }

    // Tiles are small, but their nodes are not.
    void askForNode(const openvdb::Coord& corner) {
        constexpr int kAtOnce = 64;
        if (values_.template probeConstNode<Node>(corner)) return;
        if (newNodes_++ % kAtOnce == 0) requireMemory(where_, 2.0 * kAtOnce * sizeof(Node));
    }

    const DeltaHeader& header_;
    const Words& words_;
    const std::string& where_;
    openvdb::tree::ValueAccessor<Tree> values_;
    openvdb::tree::ValueAccessor<CodeTree::Tree> inactive_;
    std::uint64_t active_ = 0;
    int newNodes_ = 0;
};

template <typename Tree>
void fillRest(const DeltaHeader& header, typename Tree::ValueType rest, const std::string& where,
              Tree& tree) {
    const glm::ivec3 low = header.box.min, high = header.box.max;
    // A filled box has leaves at its faces and a root tile per 4096^3 voxels inside.
    const glm::dvec3 dims(header.box.dims());
    const double faces = 2 * (dims.x * dims.y + dims.y * dims.z + dims.z * dims.x);
    requireClaimedMemory(where, faces / 64 * leafBytes<typename Tree::LeafNodeType>() +
                                    double(voxelsOf(header.box)) / 0x1p36 * 100);
    tree.fill({{low.x, low.y, low.z}, {high.x, high.y, high.z}}, rest, true);
}

// @param values, inactive  empty trees
template <typename Words>
void decode(typename Words::DeltaTree& deltas, const DeltaHeader& header, const Words& words,
            const std::string& where, const Listener& listener, typename Words::Tree& values,
            CodeTree::Tree& inactive) {
    if (deltas.background() != 0)
        refuseInput(where, "background " + std::to_string(deltas.background()), "0");
    const Decoder<Words> decoder(header, words, where);
    voxelizeTiles(deltas, where);
    const auto leaves = orderedLeaves(deltas, decoder);
    checkSlabs(leaves, decoder, header, where);

    // Checks the count first: without empty places, the whole box is active.
    if (header.restActive && header.inactiveValues.empty())
        requireActiveCount(voxelsOf(header.box), header, where);
    if (header.restActive && !header.box.empty()) fillRest(header, words.rest(), where, values);
    const std::vector<std::size_t> columns = columnsOf(leaves, decoder);
    Collector<Words> collector(header, words, where, values, inactive);
    // Portions let memory be requested step by step.
    constexpr std::size_t kPortion = 2048;
    for (std::size_t begin = 0; begin + 1 < columns.size(); begin += kPortion) {
        const std::size_t count = std::min(kPortion, columns.size() - 1 - begin);
        const int blocksPerColumn = header.keyInterval / 8;
        double mostBlocks = double(count) * blocksPerColumn;
        // Each block without deltas has at least one active voxel.
        if (!header.restActive && header.inactiveValues.empty())
            mostBlocks = std::min(mostBlocks, double(header.active) + double(leaves.size()));
        requireClaimedMemory(where, mostBlocks * sizeof(Block<Words>));
        std::vector<std::vector<Block<Words>>> blocks(count);
        parallelForChunks(count, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                blocks[i] = decoder.decodeColumn(&leaves[columns[begin + i]],
                                                 leaves.data() + columns[begin + i + 1]);
            }
        });
        for (auto& column : blocks) collector.add(column);
        listener.report(double(begin + count) / double(columns.size()));
    }
}

template <typename T>
DecodedValues decodeExact(TreeGrid& grid, const DeltaHeader& header, const std::string& where,
                          const Listener& listener) {
    using Words = ExactWords<T>;
    const Words words(header);
    auto values = std::make_shared<typename Words::Tree>(words.inactiveValue());
    DecodedValues decoded;
    decode(*grid.as<typename Words::DeltaTree>(), header, words, where, listener, *values,
           decoded.inactive->tree());
    decoded.values = std::move(values);
    return decoded;
}

}  // namespace

DecodedDeltas decodeDeltas(TreeGrid& grid, const DeltaHeader& header, const std::string& where,
                           const Listener& listener) {
    DecodedDeltas decoded;
    decode(*grid.as<openvdb::Int32Tree>(), header, CodeWords(header), where, listener,
           decoded.codes->tree(), decoded.inactive->tree());
    return decoded;
}

DecodedValues decodeValues(TreeGrid& grid, const DeltaHeader& header, const std::string& where,
                           const Listener& listener) {
    switch (*header.exact) {
        case ExactValues::kFloat32:
            return decodeExact<float>(grid, header, where, listener);
        case ExactValues::kFloat64:
            return decodeExact<double>(grid, header, where, listener);
        case ExactValues::kInt32:
            return decodeExact<std::int32_t>(grid, header, where, listener);
        default:
            return decodeExact<std::int64_t>(grid, header, where, listener);
    }
}

}  // namespace deltasplat
