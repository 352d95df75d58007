// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/take_deltas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/affine.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/sorting.h"
#include "deltasplat/delta/delta_grid.h"
#include "deltasplat/tolerance.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/delta_grid.h"
#include "formats/delta/exact_deltas.h"
#include "formats/delta/exact_slots.h"
#include "formats/readers.h"
#include "volume/code_blocks.h"
#include "volume/code_counts.h"
#include "volume/grid_values.h"
#include "volume/leaf_slices.h"
#include "volume/tree_from_codes.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

/// Changes codes so that a voxel keeps its value along the slice axis while the value is within
/// tolerance of the true one. Comparing with the true value each time keeps errors from adding up.
/// Each slab starts anew. Inactive voxels stay inactive; voxels that `slotMap` empties neither hold
/// nor are held. The code book's errors reduce the tolerance. Deterministic; multi-threaded.
void holdValues(Volume& volume, int sliceAxis, int keyInterval, const Tolerance& tolerance,
                std::span<const Slot> slotMap);

namespace {

// Decides which slots may stand for which.
class HoldRule {
  public:
    HoldRule(const Volume& volume, const Tolerance& tolerance)
        : values_(kSlotCount), allowed_(kSlotCount, -1) {
        for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
            if (volume.histogram()[code] == 0) continue;
            const double value = volume.codeBook().valueOf(Code(code));
            values_[code + 1] = value;
            const double codeError = volume.codeBook().largestErrorOf(Code(code)) * (1 + 1e-9);
            // Active voxels of the background's value stay so, and no others become so.
            const bool empty = volume.hasBackground() && value == volume.background();
            if (empty) values_[code + 1] = std::numeric_limits<double>::infinity();
            allowed_[code + 1] = empty ? -1 : allowance(value, tolerance, codeError);
        }
    }

    bool holds(Slot held, Slot slot) const {
        if (held == slot || held == kEmptySlot || slot == kEmptySlot) return held == slot;
        return std::fabs(values_[std::size_t(held)] - values_[std::size_t(slot)]) <=
               allowed_[std::size_t(slot)];
    }

  private:
    // The true value may be nearer to 0, and the code's farther off, by the code book's error.
    static double allowance(double value, const Tolerance& tolerance, double codeError) {
        double allowed = std::numeric_limits<double>::infinity();
        if (tolerance.value > 0) allowed = tolerance.value;
        if (tolerance.relative > 0) {
            const double nearest = std::max(0.0, std::fabs(value) - codeError);
            allowed = std::min(allowed, tolerance.relative * nearest);
        }
        return allowed - codeError;
    }

    std::vector<double> values_;
    std::vector<double> allowed_;
};

struct Changed {
    openvdb::Coord origin;
    std::unique_ptr<CodeTree::Leaf> leaf;
};

// Holds values along one column of blocks (same u and v), in place if there are leaves.
class ColumnHolder {
  public:
    ColumnHolder(const BlockReader& reader, const SlabLayout& layout, const HoldRule& rule,
                 int sliceAxis)
        : reader_(reader), layout_(layout), rule_(rule), sliceAxis_(sliceAxis) {}

    void run(const CodeBlock* begin, const CodeBlock* end, std::vector<Changed>& changed) const {
        HeldSlots held{};
        BlockSlots slots;
        for (const CodeBlock* block = begin; block != end; ++block) {
            const bool goesOn = block != begin && follows(block[-1], *block);
            if (!goesOn || layout_.startsSlab(block->position.x)) held.fill(kEmptySlot);
            reader_.readBlock(*block, slots);
            if (hold(slots, held)) changed.push_back(replaced(*block, slots));
        }
    }

  private:
    // Returns whether the held slot replaced any slot.
    bool hold(BlockSlots& slots, HeldSlots& held) const {
        bool any = false;
        const auto next = [&](Slot before, Slot slot) {
            return rule_.holds(before, slot) ? before : slot;
        };
        holdSlots(slots, held, next, [&](std::size_t i, Slot slot) {
            any |= slots[i] != slot;
            slots[i] = slot;
        });
        return any;
    }

    Changed replaced(const CodeBlock& block, const BlockSlots& slots) const {
        Changed changed{blockOrigin(block.position, sliceAxis_), nullptr};
        changed.leaf = block.leaf ? std::make_unique<CodeTree::Leaf>(*block.leaf)
                                  : std::make_unique<CodeTree::Leaf>(changed.origin, Code(0), true);
        Code* codes = changed.leaf->buffer().data();
        const Slot* slot = slots.data();
        forLeafVoxels(sliceAxis_, [&](const glm::ivec3&, int n) {
            // Empty voxels keep their code.
            if (*slot != kEmptySlot) codes[n] = Code(*slot - 1);
            ++slot;
        });
        return changed;
    }

    const BlockReader& reader_;
    const SlabLayout& layout_;
    const HoldRule& rule_;
    int sliceAxis_;
};

}  // namespace

void holdValues(Volume& volume, int sliceAxis, int keyInterval, const Tolerance& tolerance,
                std::span<const Slot> slotMap) {
    if (volume.empty() || tolerance.isExact()) return;
    const SlabLayout layout = layoutOf(permutedBox(volume.box(), sliceAxis), keyInterval);
    const BlockReader reader(*volume.codes(), nullptr, sliceAxis, slotMap);
    const HoldRule rule(volume, tolerance);
    const ColumnHolder holder(reader, layout, rule, sliceAxis);
    requireMemory("tolerance", double(reader.blocks().size()) * (sizeof(Changed) + 1200));

    const std::vector<std::size_t> columns = runBegins(reader.blocks(), shareColumn);
    std::vector<std::vector<Changed>> changed(columns.size() - 1);
    parallelForChunks(changed.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const CodeBlock* blocks = reader.blocks().data();
            holder.run(blocks + columns[i], blocks + columns[i + 1], changed[i]);
        }
    });

    const auto codes = std::make_shared<CodeTree>(std::in_place, volume.codes()->tree());
    openvdb::tree::ValueAccessor<CodeTree::Tree> accessor(codes->tree());
    for (auto& column : changed) {
        for (Changed& block : column) accessor.addLeaf(block.leaf.release());
    }
    VolumeData held = volume.data();
    held.histogram = histogramOf(codes->tree());
    held.codes = codes;
    summarize(held);
    volume = Volume(std::move(held));
}

}  // namespace

namespace {

// The state without deltas: inactive, or the most frequent code if all voxels are active.
struct Rest {
    bool active = false;
    double background = 0;
    std::vector<Slot> slotMap;  // makes the resting code empty
};

Rest restOf(const Volume& volume) {
    Rest rest;
    rest.active = !volume.hasBackground();
    rest.background = volume.background();
    if (!rest.active || volume.empty()) return rest;
    const auto most = std::max_element(volume.histogram().begin(), volume.histogram().end());
    const auto code = Code(most - volume.histogram().begin());
    rest.background = volume.codeBook().valueOf(code);
    rest.slotMap.resize(kSlotCount);
    for (Slot slot = 0; slot < kSlotCount; ++slot) rest.slotMap[std::size_t(slot)] = slot;
    rest.slotMap[code + 1u] = kEmptySlot;
    return rest;
}

int mostComparableAxis(const Volume& volume, std::span<const Slot> slotMap) {
    int best = 2;
    std::uint64_t fewest = countDeltas(volume, 2, slotMap).deltas;
    for (const int axis : {1, 0}) {
        const std::uint64_t deltas = countDeltas(volume, axis, slotMap).deltas;
        if (deltas >= fewest) continue;
        fewest = deltas;
        best = axis;
    }
    return best;
}

// Returns the size of a table, or else one more than the largest code in use.
int codeCountOf(const Volume& volume) {
    if (volume.codeBook().table) return int(volume.codeBook().table->size());
    const auto& counts = volume.histogram();
    const auto used = [](std::uint64_t count) { return count != 0; };
    const auto last = std::find_if(counts.rbegin(), counts.rend(), used);
    return std::max(1, int(counts.rend() - last));
}

IndexBox united(IndexBox box, const InactiveValues& inactive) {
    openvdb::CoordBBox more;
    if (!inactive.numbers || !inactive.numbers->tree().evalActiveVoxelBoundingBox(more)) return box;
    return boxOfBoth(box, {{more.min().x(), more.min().y(), more.min().z()},
                           {more.max().x(), more.max().y(), more.max().z()}});
}

// Whether a table, stored as text, takes more than codes can save: values' bytes beyond 16 bits.
bool isTableLarger(const Volume& volume) {
    if (volume.codeBook().kind != CodeBook::Kind::kTable) return false;
    const bool isWide = volume.type() == "double" || volume.type().ends_with("64");
    return listText(*volume.codeBook().table).size() > (isWide ? 6 : 2) * volume.activeCount();
}

template <typename Tree>
std::shared_ptr<Tree> treeOfCodes(const Volume& volume) {
    using Leaf = typename Tree::LeafNodeType;
    const CodeTree::Tree& codes = volume.codes()->tree();
    requireMemory("grid \"" + volume.name() + "\"", double(codes.leafCount()) * leafBytes<Leaf>());
    return treeFromCodes<Tree>(codes, volume.codeBook(), 0);
}

// Returns the tree of a volume without empty places whose codes are exact.
std::shared_ptr<openvdb::TreeBase> treeOfExactCodes(const Volume& volume) {
    if (volume.type() == "float32") return treeOfCodes<openvdb::FloatTree>(volume);
    if (volume.type() == "int32") return treeOfCodes<openvdb::Int32Tree>(volume);
    if (volume.type() == "uint32" || volume.type() == "int64")
        return treeOfCodes<openvdb::Int64Tree>(volume);
    return treeOfCodes<openvdb::DoubleTree>(volume);
}

struct StoredValues {
    TreeGrid grid;
    ExactValues type;
};

// Returns nothing if codes are stored: exact and worth their bytes, asked for, or the only way.
std::optional<StoredValues> valuesToStore(const Volume& volume, const DeltaFileOptions& options) {
    if (options.codesOnly || !options.tolerance.isExact()) return {};
    // A lossy delta grid has already lost its source's values.
    if (isOfCodes(volume) && volume.origin()->maxError > 0) return {};
    const bool isExact = volume.codeBook().isExact();
    if (isExact && !isTableLarger(volume)) return {};
    if (!volume.hasBackground() && volume.box().min != glm::ivec3(0)) return {};
    TreeGrid grid;
    if (volume.source()) {
        grid = volume.source()->grid;
    } else if (isExact && !volume.hasBackground()) {
        grid.tree = treeOfExactCodes(volume);
    }
    if (!grid.tree) return {};
    const std::optional<ExactValues> type = exactValuesOf(grid);
    if (!type) return {};
    return StoredValues{grid, *type};
}

// Files store deltas as zigzag numbers.
void removeSigns(openvdb::Int32Tree& deltas) {
    std::vector<DeltaTree::Leaf*> leaves;
    deltas.getNodes(leaves);
    parallelForChunks(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            // Inactive deltas are 0 and stay 0, so masks need no look.
            std::int32_t* const values = leaves[i]->buffer().data();
            std::transform(values, values + DeltaTree::Leaf::SIZE, values,
                           [](std::int32_t delta) { return toZigzag(delta); });
        }
    });
}

DeltaHeader headerOf(const Volume& volume, const Rest& rest, const InactiveValues& inactive,
                     const Tolerance& tolerance) {
    DeltaHeader header;
    header.book = volume.codeBook();
    header.sourceType = volume.type();
    header.space = volume.space();
    header.background = rest.background;
    header.restActive = rest.active;
    header.inactiveValues = inactive.values;
    header.active = volume.activeCount();
    // A source that was a delta grid has an error of its own.
    const DeltaOrigin before = volume.origin().value_or(DeltaOrigin());
    // (1 + t) (1 + b) - 1, exact if there was no error before.
    const double t = tolerance.relative;
    header.tolerance = t + before.tolerance + t * before.tolerance;
    header.toleranceValue = tolerance.value + before.toleranceValue;
    header.maxError = std::max(before.maxError, volume.readError());
    return header;
}

// Lets whole numbers begin with the smallest in use: a change from or to empty costs a whole slot.
std::vector<Slot> beginLow(const Volume& volume, const Rest& rest, DeltaHeader& header) {
    if (header.book.kind != CodeBook::Kind::kInteger || volume.empty()) return rest.slotMap;
    const auto& counts = volume.histogram();
    const auto used = [](std::uint64_t count) { return count != 0; };
    const auto first = Slot(std::find_if(counts.begin(), counts.end(), used) - counts.begin());
    const double offset = header.book.valueOf(Code(first));
    if (first == 0 || offset - header.book.offset != double(first)) return rest.slotMap;
    std::vector<Slot> slotMap(kSlotCount, kEmptySlot);
    for (Slot slot = first + 1; slot < kSlotCount; ++slot) {
        const bool rests = !rest.slotMap.empty() && rest.slotMap[std::size_t(slot)] == kEmptySlot;
        if (!rests) slotMap[std::size_t(slot)] = slot - first;
    }
    header.book.offset = offset;
    header.codeCount -= int(first);
    return slotMap;
}

std::shared_ptr<openvdb::TreeBase> takeCodes(const Volume& volume, const Rest& rest,
                                             const InactiveValues& inactive,
                                             const Tolerance& tolerance, DeltaHeader& header) {
    VolumeData boxed = volume.data();
    boxed.box = header.box;
    Volume held(std::move(boxed));
    holdValues(held, header.sliceAxis, header.keyInterval, tolerance, rest.slotMap);
    header.codeCount = codeCountOf(held);
    const std::vector<Slot> slotMap = beginLow(held, rest, header);
    DeltaOptions options;
    options.slotMap = slotMap;
    options.inactive = inactive.numbers.get();
    options.sliceAxis = header.sliceAxis;
    options.keyInterval = header.keyInterval;
    const DeltaGrid deltas = makeDeltaGrid(held, options);
    for (const Slab& slab : deltas.slabs) header.slabDeltas.push_back(slab.deltas);
    removeSigns(*deltas.tree->deltas);
    return deltas.tree->deltas;
}

std::shared_ptr<openvdb::TreeBase> takeValues(const Volume& volume, const StoredValues& values,
                                              const InactiveValues& inactive, DeltaHeader& header) {
    header.exact = values.type;
    std::optional<double> rest;
    if (header.restActive) {
        rest = 0;
        if (volume.mostFrequent() && hasSlot(values.type, volume.mostFrequent()->value))
            rest = volume.mostFrequent()->value;
        header.background = *rest;
    }
    ExactDeltas taken = takeExactDeltas(
        values.grid, {header.sliceAxis, header.keyInterval, header.box, rest, inactive},
        "grid \"" + volume.name() + "\"");
    header.slabDeltas = std::move(taken.slabDeltas);
    return taken.deltas;
}

}  // namespace

TakenDeltas takeDeltas(const Volume& volume, const DeltaFileOptions& options,
                       const Listener& listener) {
    TakenDeltas taken;
    DeltaHeader& header = taken.header;
    const TreeGrid* const source = volume.source() ? &volume.source()->grid : nullptr;
    if (source && volume.hasBackground()) taken.inactive = findInactiveValues(*source);
    const InactiveValues& inactive = taken.inactive;
    Rest rest = restOf(volume);
    // A non-finite background was replaced in `volume`, but not in its own grid.
    if (volume.hasBackground() && source) rest.background = backgroundOf(*source);
    listener.report(0.2);

    header = headerOf(volume, rest, inactive, options.tolerance);
    if (options.pack) header.version = DeltaHeader::kPackedVersion;
    header.box = united(volume.box(), inactive);
    header.sliceAxis =
        options.sliceAxis ? *options.sliceAxis : mostComparableAxis(volume, rest.slotMap);
    header.keyInterval = options.keyInterval != 0
                             ? options.keyInterval
                             : defaultKeyInterval(header.box.dims()[header.sliceAxis]);
    listener.report(0.5);
    const std::optional<StoredValues> values = valuesToStore(volume, options);
    taken.deltas = values ? takeValues(volume, *values, inactive, header)
                          : takeCodes(volume, rest, inactive, options.tolerance, header);
    listener.report(1);
    return taken;
}

}  // namespace deltasplat
