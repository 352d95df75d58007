// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 6, for values of which there are more than codes.
#include "formats/delta/exact_deltas.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/sorting.h"
#include "formats/delta/exact_slots.h"
#include "volume/book_encoder.h"
#include "volume/code_tree.h"
#include "volume/grid_values.h"
#include "volume/leaf_slices.h"
#include "volume/tree_types.h"
#include "volume/value_cast.h"
#include "volume/value_census.h"

namespace deltasplat {

namespace {

// Blocks that do not rest: one with voxels of its own, or any number along the slices of one slot.
struct Run {
    glm::ivec3 position;  // first block, in (slice, u, v) order, divided by 8
    int blocks;
};

template <typename T>
class Taker {
  public:
    using Slots = ExactSlots<T>;
    using Slot = typename Slots::Slot;
    using Tree = typename openvdb::tree::Tree4<T, 5, 4, 3>::Type;
    using DeltaTree = typename Slots::DeltaTree;
    using DeltaLeaf = typename DeltaTree::LeafNodeType;
    using Leaves = std::vector<std::unique_ptr<DeltaLeaf>>;

    Taker(const Tree& tree, const ExactDeltaOptions& options, const std::string& where)
        : tree_(tree),
          options_(options),
          where_(where),
          first_(toSliceOrder(options.box.min, options.sliceAxis)),
          last_(toSliceOrder(options.box.max, options.sliceAxis)) {
        if (options.rest) rest_ = Slots::slotOf(valueAs<T>(*options.rest));
    }

    int slabOf(int block) const { return (block - (first_.x >> 3)) / (options_.keyInterval / 8); }
    int slabs() const { return options_.box.empty() ? 0 : slabOf(last_.x >> 3) + 1; }

    // Returns the runs of all that does not rest, by columns and slices.
    std::vector<Run> runs() const {
        std::vector<Run> runs;
        for (auto leaf = tree_.cbeginLeaf(); leaf; ++leaf)
            addRuns(leaf->getNodeBoundingBox(), runs);
        addTiles(tree_.cbeginValueOn(), runs);
        if (const CodeTree* const inactive = options_.inactive.numbers.get()) {
            // Leaves of both trees were added above.
            for (auto leaf = inactive->tree().cbeginLeaf(); leaf; ++leaf) {
                if (!tree_.probeConstLeaf(leaf->origin()))
                    addRuns(leaf->getNodeBoundingBox(), runs);
            }
            addTiles(inactive->tree().cbeginValueOn(), runs);
        }
        std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
            return std::tuple(a.position.y, a.position.z, a.position.x) <
                   std::tuple(b.position.y, b.position.z, b.position.x);
        });
        return runs;
    }

    Leaves takeColumn(const Run* begin, const Run* end) const {
        Column column(*this, begin->position);
        for (const Run* run = begin; run != end; ++run) {
            if (run->position.x != column.next) column.close();
            column.add(*run);
        }
        column.close();
        return std::move(column.leaves);
    }

  private:
    using SliceSlots = std::array<Slot, 64>;
    using BlockSlots = std::array<Slot, 512>;

    struct Column {
        Column(const Taker& of, const glm::ivec3& position)
            : taker(of), u(position.y), v(position.z), source(of.tree_) {
            if (taker.options_.inactive.numbers)
                inactive.emplace(taker.options_.inactive.numbers->tree());
        }

        void add(const Run& run) {
            BlockSlots slots;
            const int end = run.position.x + run.blocks;
            for (next = run.position.x; next < end;) {
                if (next == run.position.x) readBlock(next, slots);
                takeBlock(next, slots);
                ++next;
                // Within a run, nothing changes until the next key slice.
                while (next < end && taker.slabOf(next) == slab) ++next;
            }
        }

        // Lets the column return to rest behind its last block.
        void close() {
            const bool isOn =
                std::any_of(held.begin(), held.end(), [](Slot slot) { return slot != 0; });
            if (!isOn || next > taker.last_.x >> 3 || taker.slabOf(next) != slab) return;
            takeBlock(next, BlockSlots{});
            held = {};
        }

        void takeBlock(int block, const BlockSlots& slots) {
            if (taker.slabOf(block) != slab) {
                slab = taker.slabOf(block);
                held = {};
            }
            std::unique_ptr<DeltaLeaf> leaf;
            const Slot* inOrder = slots.data();
            const int slices = std::min(8, taker.last_.x - 8 * block + 1);
            for (int s = 0; s < slices; ++s) {
                for (int n = 0; n < 64; ++n) {
                    const Slot slot = *inOrder++;
                    Slot& before = held[std::size_t(n)];
                    if (slot == before) continue;
                    if (!leaf) {
                        requireMemory(taker.where_, leafBytes<DeltaLeaf>());
                        leaf = std::make_unique<DeltaLeaf>(openvdb::Coord(8 * block, 8 * u, 8 * v),
                                                           0, false);
                    }
                    leaf->setValueOn(openvdb::Index(64 * s + n),
                                     toZigzag(typename Slots::Delta(slot - before)));
                    before = slot;
                }
            }
            if (leaf) leaves.push_back(std::move(leaf));
        }

        void readBlock(int block, BlockSlots& slots) {
            const openvdb::Coord origin =
                blockOrigin(glm::ivec3(block, u, v), taker.options_.sliceAxis);
            const auto* const numbers = inactive ? inactive->probeConstLeaf(origin) : nullptr;
            const auto* const values = source.probeConstLeaf(origin);
            if (!values && !numbers) {
                slots.fill(tileSlot(origin));
                return;
            }
            Slot* out = slots.data();
            forLeafVoxels(taker.options_.sliceAxis, [&](const glm::ivec3&, int n) {
                const auto at = openvdb::Index(n);
                Slot slot = 0;
                if (values && values->isValueOn(at)) {
                    slot = taker.valueSlot(values->getValue(at));
                } else if (numbers && numbers->isValueOn(at)) {
                    slot = Slots::firstInactive() + Slot(numbers->getValue(at));
                }
                *out++ = slot;
            });
        }

        Slot tileSlot(const openvdb::Coord& origin) {
            if (source.isValueOn(origin)) return taker.valueSlot(source.getValue(origin));
            Code number = 0;
            if (!inactive || !inactive->probeValue(origin, number)) return 0;
            return Slots::firstInactive() + Slot(number);
        }

        const Taker& taker;
        int u, v;
        openvdb::tree::ValueAccessor<const Tree> source;
        std::optional<openvdb::tree::ValueAccessor<const CodeTree::Tree>> inactive;
        SliceSlots held{};
        int slab = -1;
        int next = 0;  // block behind the last run
        Leaves leaves;
    };

    Slot valueSlot(T value) const {
        const Slot slot = Slots::slotOf(value);
        return rest_ && slot == *rest_ ? 0 : slot;
    }

    void addRuns(const openvdb::CoordBBox& box, std::vector<Run>& runs) const {
        const auto block = [&](const openvdb::Coord& place) {
            return toSliceOrder(glm::ivec3(place.x() >> 3, place.y() >> 3, place.z() >> 3),
                                options_.sliceAxis);
        };
        const glm::ivec3 low = block(box.min()), high = block(box.max());
        requireMemory(where_, double(high.y - low.y + 1) * (high.z - low.z + 1) * sizeof(Run));
        for (int u = low.y; u <= high.y; ++u) {
            for (int v = low.z; v <= high.z; ++v)
                runs.push_back({{low.x, u, v}, high.x - low.x + 1});
        }
    }

    template <typename Values>
    void addTiles(Values tile, std::vector<Run>& runs) const {
        tile.setMaxDepth(Values::LEAF_DEPTH - 1);
        for (; tile; ++tile) addRuns(tile.getBoundingBox(), runs);
    }

    const Tree& tree_;
    const ExactDeltaOptions& options_;
    const std::string& where_;
    glm::ivec3 first_;
    glm::ivec3 last_;
    std::optional<Slot> rest_;
};

template <typename Tree>
ExactDeltas take(const Tree& tree, const ExactDeltaOptions& options, const std::string& where) {
    using T = typename Tree::ValueType;
    using Deltas = typename ExactSlots<T>::DeltaTree;
    const Taker<T> taker(tree, options, where);
    const std::vector<Run> runs = taker.runs();
    const std::vector<std::size_t> columns = runBegins(runs, [](const Run& a, const Run& b) {
        return a.position.y == b.position.y && a.position.z == b.position.z;
    });
    std::vector<typename Taker<T>::Leaves> leaves(columns.size() - 1);
    parallelForChunks(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            leaves[i] = taker.takeColumn(&runs[columns[i]], runs.data() + columns[i + 1]);
    });
    auto deltas = std::make_shared<Deltas>(0);
    ExactDeltas taken;
    taken.slabDeltas.resize(std::size_t(taker.slabs()));
    openvdb::tree::ValueAccessor<Deltas> accessor(*deltas);
    for (auto& column : leaves) {
        for (auto& leaf : column) {
            taken.slabDeltas[std::size_t(taker.slabOf(leaf->origin().x() >> 3))] +=
                leaf->onVoxelCount();
            accessor.addLeaf(leaf.release());
        }
    }
    taken.deltas = std::move(deltas);
    return taken;
}

}  // namespace

std::optional<ExactValues> exactValuesOf(const TreeGrid& grid) {
    if (grid.as<openvdb::FloatTree>()) return ExactValues::kFloat32;
    if (grid.as<openvdb::DoubleTree>()) return ExactValues::kFloat64;
    if (grid.as<openvdb::Int32Tree>()) return ExactValues::kInt32;
    const auto* const wide = grid.as<openvdb::Int64Tree>();
    if (!wide) return {};
    for (auto value = wide->cbeginValueOn(); value; ++value) {
        if (*value > ExactSlots<std::int64_t>::largest()) return {};
    }
    return ExactValues::kInt64;
}

ExactDeltas takeExactDeltas(const TreeGrid& grid, const ExactDeltaOptions& options,
                            const std::string& where) {
    ExactDeltas taken;
    grid.apply<ExactTrees>([&](const auto& tree) { taken = take(tree, options, where); });
    return taken;
}

namespace {

// Calls use(origin, value, box) for inactive voxels (without box) and tiles other than background.
template <typename Tree, typename Use>
void forInactive(const Tree& tree, const Use& use) {
    const auto background = double(tree.background());
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
        if (leaf->isDense()) continue;
        for (auto voxel = leaf->cbeginValueOff(); voxel; ++voxel) {
            if (!haveSameBits(double(*voxel), background))
                use(voxel.getCoord(), double(*voxel), nullptr);
        }
    }
    auto tile = tree.cbeginValueOff();
    tile.setMaxDepth(Tree::ValueOffCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (haveSameBits(double(*tile), background)) continue;
        const openvdb::CoordBBox box = tile.getBoundingBox();
        use(box.min(), double(*tile), &box);
    }
}

// Whether inactive values or the background are whole numbers that no double holds.
template <typename Tree>
bool hasRounded(const Tree& tree) {
    using T = typename Tree::ValueType;
    if constexpr (std::is_same_v<T, std::int64_t>) {
        const auto isRounded = [](T value) { return valueAs<T>(double(value)) != value; };
        if (isRounded(tree.background())) return true;
        for (auto value = tree.cbeginValueOff(); value; ++value) {
            if (isRounded(*value)) return true;
        }
    }
    return false;
}

template <typename Tree>
InactiveValues find(const Tree& tree) {
    InactiveValues found;
    found.rounded = hasRounded(tree);
    DistinctValues distinct;
    forInactive(tree,
                [&](const auto&, double value, const openvdb::CoordBBox*) { distinct.add(value); });
    found.tooMany = distinct.tooMany();
    if (!found.tooMany) found.values = distinct.sorted();
    if (found.values.empty()) return found;

    const BookEncoder encoder(CodeBook::ofTable(found.values));
    auto numbers = std::make_shared<CodeTree>();
    openvdb::tree::ValueAccessor<CodeTree::Tree> accessor(numbers->tree());
    forInactive(tree, [&](const openvdb::Coord& at, double value, const openvdb::CoordBBox* box) {
        if (box) {
            numbers->tree().fill(*box, encoder(value), true);
        } else {
            accessor.setValueOn(at, encoder(value));
        }
    });
    found.numbers = std::move(numbers);
    return found;
}

}  // namespace

double backgroundOf(const TreeGrid& grid) {
    double background = 0;
    grid.apply<ScalarTrees>([&](const auto& tree) { background = double(tree.background()); });
    return background;
}

InactiveValues findInactiveValues(const TreeGrid& grid) {
    InactiveValues found;
    grid.apply<ScalarTrees>([&](const auto& tree) { found = find(tree); });
    return found;
}

}  // namespace deltasplat
