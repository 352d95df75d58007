// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/take_deltas.h"

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/affine.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/delta_grid.h"
#include "formats/delta/delta_origin.h"
#include "formats/delta/exact_deltas.h"
#include "formats/delta/exact_slots.h"
#include "formats/delta/hold_values.h"
#include "volume/grid_values.h"
#include "volume/leaf_bytes.h"
#include "volume/tree_from_codes.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

// What no delta speaks of: inactive voxels, or in a volume without any the most frequent code.
struct Rest {
    bool active = false;
    double background = 0;
    std::vector<Slot> slotMap;  // makes the resting code empty
};

Rest restOf(const Volume& volume) {
    Rest rest;
    rest.active = !volume.hasBackground;
    rest.background = volume.background;
    if (!rest.active || volume.empty()) return rest;
    const auto most = std::max_element(volume.histogram.begin(), volume.histogram.end());
    const auto code = Code(most - volume.histogram.begin());
    rest.background = volume.codeBook.valueOf(code);
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

// The codes of a table, otherwise those up to the largest one in use.
int codeCountOf(const Volume& volume) {
    if (volume.codeBook.table) return int(volume.codeBook.table->size());
    const auto& counts = volume.histogram;
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

// Whether a table, which files have as text, is more than its codes can save, which is no more than
// what values have beyond 16 bits.
bool isTableLarger(const Volume& volume) {
    if (volume.codeBook.kind != CodeBook::Kind::kTable) return false;
    const bool isWide = volume.type == "double" || volume.type.ends_with("64");
    return listText(*volume.codeBook.table).size() > (isWide ? 6 : 2) * volume.activeCount;
}

template <typename Tree>
std::shared_ptr<Tree> treeOfCodes(const Volume& volume) {
    using Leaf = typename Tree::LeafNodeType;
    const CodeTree::Tree& codes = volume.codes->tree();
    requireMemory("grid \"" + volume.name + "\"", double(codes.leafCount()) * leafBytes<Leaf>());
    return treeFromCodes<Tree>(codes, volume.codeBook, 0);
}

// The tree of a volume without empty places, whose codes are exact.
std::shared_ptr<openvdb::TreeBase> treeOfExactCodes(const Volume& volume) {
    if (volume.type == "float32") return treeOfCodes<openvdb::FloatTree>(volume);
    if (volume.type == "int32") return treeOfCodes<openvdb::Int32Tree>(volume);
    if (volume.type == "uint32" || volume.type == "int64")
        return treeOfCodes<openvdb::Int64Tree>(volume);
    return treeOfCodes<openvdb::DoubleTree>(volume);
}

// What goes into the file by its values' own bits.
struct StoredValues {
    TreeGrid grid;
    ExactValues type;
};

// Empty if codes go into the file: values have an exact code book that is worth its bytes, or less
// is asked for, or there is no other way.
std::optional<StoredValues> valuesToStore(const Volume& volume, const DeltaFileOptions& options) {
    if (options.codesOnly || !options.tolerance.isExact()) return {};
    // Deltas of codes have lost already what their source had besides.
    if (isOfCodes(volume) && volume.origin->maxError > 0) return {};
    const bool isExact = volume.codeBook.isExact();
    if (isExact && !isTableLarger(volume)) return {};
    if (!volume.hasBackground && volume.box.min != glm::ivec3(0)) return {};
    TreeGrid grid;
    if (volume.source) {
        grid = volume.source->grid;
    } else if (isExact && !volume.hasBackground) {
        grid.tree = treeOfExactCodes(volume);
    }
    if (!grid.tree) return {};
    const std::optional<ExactValues> type = exactValuesOf(grid);
    if (!type) return {};
    return StoredValues{grid, *type};
}

// Deltas go into files as numbers without sign.
void removeSigns(openvdb::Int32Tree& deltas) {
    std::vector<DeltaTree::Leaf*> leaves;
    deltas.getNodes(leaves);
    parallelForChunks(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            // Inactive ones as well, which are 0 and stay so: without looking at masks.
            std::int32_t* const values = leaves[i]->buffer().data();
            std::transform(values, values + DeltaTree::Leaf::SIZE, values,
                           [](std::int32_t delta) { return toZigzag(delta); });
        }
    });
}

DeltaHeader headerOf(const Volume& volume, const Rest& rest, const InactiveValues& inactive,
                     const Tolerance& tolerance) {
    DeltaHeader header;
    header.book = volume.codeBook;
    header.sourceType = volume.type;
    header.space = volume.space;
    header.background = rest.background;
    header.restActive = rest.active;
    header.inactiveValues = inactive.values;
    header.active = volume.activeCount;
    // A source that was a delta grid itself has an error of its own.
    const DeltaOrigin before = volume.origin.value_or(DeltaOrigin());
    // (1 + t) (1 + b) - 1, exact where there was none before.
    const double t = tolerance.relative;
    header.tolerance = t + before.tolerance + t * before.tolerance;
    header.toleranceValue = tolerance.value + before.toleranceValue;
    header.maxError = std::max(before.maxError, volume.readError);
    return header;
}

// Lets whole numbers begin with the smallest in use: rest is 0, and what comes from it or goes to
// it is a change by all that a slot is.
std::vector<Slot> beginLow(const Volume& volume, const Rest& rest, DeltaHeader& header) {
    if (header.book.kind != CodeBook::Kind::kInteger || volume.empty()) return rest.slotMap;
    const auto& counts = volume.histogram;
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
    Volume held = volume;
    held.box = header.box;
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
        if (volume.mostFrequent && hasSlot(values.type, volume.mostFrequent->value))
            rest = volume.mostFrequent->value;
        header.background = *rest;
    }
    ExactDeltas taken = takeExactDeltas(
        values.grid, {header.sliceAxis, header.keyInterval, header.box, rest, inactive},
        "grid \"" + volume.name + "\"");
    header.slabDeltas = std::move(taken.slabDeltas);
    return taken.deltas;
}

}  // namespace

TakenDeltas takeDeltas(const Volume& volume, const DeltaFileOptions& options,
                       const Listener& listener) {
    TakenDeltas taken;
    DeltaHeader& header = taken.header;
    const TreeGrid* const source = volume.source ? &volume.source->grid : nullptr;
    if (source && volume.hasBackground) taken.inactive = findInactiveValues(*source);
    const InactiveValues& inactive = taken.inactive;
    Rest rest = restOf(volume);
    // A background that is no number has been replaced in `volume`, but not in its own grid.
    if (volume.hasBackground && source) rest.background = backgroundOf(*source);
    listener.report(0.2);

    header = headerOf(volume, rest, inactive, options.tolerance);
    if (options.pack) header.version = DeltaHeader::kPackedVersion;
    header.box = united(volume.box, inactive);
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
