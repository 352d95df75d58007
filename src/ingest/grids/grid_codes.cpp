// SPDX-License-Identifier: Apache-2.0
#include "ingest/grids/grid_codes.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetUtil.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include "deltasplat/error.h"
#include "ingest/codes/book_encoder.h"
#include "ingest/codes/code_counts.h"
#include "ingest/codes/code_tree.h"
#include "ingest/codes/error_meter.h"
#include "ingest/grids/grid_values.h"
#include "ingest/grids/not_finite.h"
#include "ingest/grids/scalar_grids.h"
#include "ingest/readers.h"
#include "ingest/values/float_kernels.h"
#include "number_text.h"
#include "shared_progress.h"

namespace deltasplat {
namespace {

[[noreturn]] void fail(const std::string& where, const std::string& got,
                       const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(where, got, expected));
}

// What is told soon, and mostly is enough.
constexpr ScanWishes kNumbersAlone{.distinct = false, .survey = false};

// Replaces what is not finite, or refuses it.
template <typename Grid>
void settleNonFinite(Grid& grid, const GridScan& range, const GridCodesOptions& options) {
    if (!options.reading.nanValue) {
        const std::string got =
            std::to_string(range.nonFinite) + " NaN or infinite active values, the first at (" +
            std::to_string(range.first.x()) + ", " + std::to_string(range.first.y()) + ", " +
            std::to_string(range.first.z()) + ")";
        throw NotFinite(
            ErrorCode::kInput,
            gotExpected(options.where, got, "finite values (`nanValue` VALUE replaces them)"));
    }
    if constexpr (std::is_same_v<typename Grid::ValueType, float>) {
        requireFloatNan(*options.reading.nanValue);
    }
    replaceNonFinite(grid.tree(), typename Grid::ValueType(*options.reading.nanValue));
    options.listener.warn(options.where + ": " + std::to_string(range.nonFinite) +
                          " NaN or infinite active values replaced by " +
                          numberText(*options.reading.nanValue));
}

// Returns whether the grid was a level set, and has been made fog.
template <typename Grid>
bool makeFog(Grid& grid, const GridCodesOptions& options) {
    if (grid.getGridClass() != openvdb::GRID_LEVEL_SET || !options.reading.levelSetToFog)
        return false;
    // Simulation caches label whole fields of distances as level sets, with a background of 0.
    const double width = double(grid.background());
    if (!(width > 0) || !std::isfinite(width)) {
        options.listener.warn(options.where + ": level set with background " + numberText(width) +
                              " kept as it is, not made fog");
        return false;
    }
    openvdb::tools::sdfToFogVolume(grid);
    return true;
}

// Puts the codes of a leaf's active voxels where these are.
void spread(const Code* codes, CodeTree::Leaf& leaf) {
    Code* out = leaf.buffer().data();
    for (openvdb::Index row = 0; row < CodeTree::Leaf::SIZE; row += 64) {
        auto active = leaf.valueMask().getWord<std::uint64_t>(row / 64);
        if (active == ~std::uint64_t{0}) {
            std::copy_n(codes, 64, out + row);
            codes += 64;
            continue;
        }
        for (; active != 0; active &= active - 1) out[row + std::countr_zero(active)] = *codes++;
    }
}

// Fills the leaves of a tree, and counts their codes: codesOf(worker, i, out) writes those of the
// active voxels of leaf i, in the order of their places.
template <typename CodesOf>
void fillLeaves(CodeTree::Tree& codes, CodeCounts& counts, const CodesOf& codesOf) {
    std::vector<CodeTree::Leaf*> leaves;
    codes.getNodes(leaves);
    forLeafRuns(leaves.size(), counts.workers(),
                [&](std::size_t worker, std::size_t begin, std::size_t end) {
                    LeafRoom<CodeTree::Leaf> room;
                    for (std::size_t i = begin; i < end; ++i) {
                        CodeTree::Leaf& leaf = *leaves[i];
                        const bool isDense = leaf.isDense();
                        Code* const out = isDense ? leaf.buffer().data() : room.data();
                        codesOf(worker, i, out);
                        counts.add(worker, {out, std::size_t(leaf.onVoxelCount())});
                        if (!isDense) spread(out, leaf);
                    }
                });
}

// Turns values into the codes of a book.
template <typename T>
void encodeAll(const CodeBook& book, const BookEncoder& encode, std::span<const T> values,
               Code* codes) {
    if constexpr (std::is_same_v<T, float>) {
        constexpr double kLargest = (1 << 24) - kCodeCount;
        if (book.kind == CodeBook::Kind::kHalf) return codesOfHalves(values, codes);
        if (book.kind == CodeBook::Kind::kInteger && std::abs(book.offset) <= kLargest)
            return codesOfWhole(values, float(book.offset), codes);
    }
    for (const T value : values) *codes++ = encode(double(value));
}

template <typename Tree>
std::shared_ptr<CodeTree> codesOfTree(const Tree& tree, const CodeBook& book, ErrorMeter& meter,
                                      CodeCounts& counts) {
    const BookEncoder encode(book);
    const bool exact = book.isExact();
    using SourceLeaf = typename Tree::LeafNodeType;
    // OpenVDB's trees cannot be assigned, only made in place.
    std::shared_ptr<CodeTree> codes(
        new CodeTree(std::in_place, tree, Code{0}, openvdb::TopologyCopy()));
    std::vector<const SourceLeaf*> sources;
    tree.getNodes(sources);
    std::vector<ErrorMeter::Part> parts(counts.workers(), ErrorMeter::Part(meter));
    fillLeaves(codes->tree(), counts, [&](std::size_t worker, std::size_t i, Code* out) {
        LeafRoom<SourceLeaf> room;
        const auto values = activeValues(*sources[i], room);
        encodeAll(book, encode, values, out);
        if (exact) return;
        for (std::size_t n = 0; n < values.size(); ++n)
            parts[worker].add(double(values[n]), out[n]);
    });
    forActiveTiles(codes->tree(), [&](const auto& tile) {
        const auto value = double(tree.getValue(tile.getCoord()));
        tile.setValue(encode(value));
        counts.add(0, *tile, tile.getVoxelCount());
        if (!exact) parts[0].add(value, *tile);
    });
    for (const ErrorMeter::Part& part : parts) meter.add(part);
    return codes;
}

IndexBox boxOf(const CodeTree::Tree& tree, const std::string& where) {
    openvdb::CoordBBox active;
    if (!tree.evalActiveVoxelBoundingBox(active)) return {};
    IndexBox box;
    double voxels = 1;
    bool fits = true;
    for (int axis = 0; axis < 3; ++axis) {
        constexpr int kFarthest = 1 << 30;
        box.min[axis] = active.min()[axis];
        box.max[axis] = active.max()[axis];
        fits = fits && box.min[axis] > -kFarthest && box.max[axis] < kFarthest;
        voxels *= double(box.max[axis]) - box.min[axis] + 1;
    }
    if (!fits || voxels > 0x1p62) {
        fail(where, "active voxels spread over " + numberText(voxels) + " places",
             "indices within 2^30 of 0 and a box of at most 2^62 voxels");
    }
    return box;
}

void takeCodes(std::shared_ptr<CodeTree> codes, CodeCounts& counts, const GridCodesOptions& options,
               Volume& volume) {
    volume.box = boxOf(codes->tree(), options.where);
    volume.histogram = counts.take();
    volume.codes = std::move(codes);
    summarize(volume);
}

template <typename Grid>
void takeBackground(const Grid& grid, Volume& volume) {
    volume.hasBackground = true;
    volume.background = double(grid.background());
}

void describeGrid(const openvdb::GridBase& grid, const GridCodesOptions& options, Volume& volume) {
    volume.type = options.type;
    volume.gridClass = openvdb::GridBase::gridClassToString(grid.getGridClass());
}

template <typename Grid>
void fill(Grid& grid, const GridCodesOptions& options, Volume& volume) {
    using T = typename Grid::ValueType;
    GridScan scan = scanTree(grid.tree(), kNumbersAlone);
    if constexpr (std::is_floating_point_v<T>) {
        volume.replaced = scan.nonFinite;
        if (scan.nonFinite > 0) settleNonFinite(grid, scan, options);
        volume.fromLevelSet = makeFog(grid, options);
        if (volume.replaced > 0 || volume.fromLevelSet) scan = scanTree(grid.tree(), kNumbersAlone);
    }
    constexpr bool kReal = std::is_floating_point_v<T>;
    const bool isLinear = kReal && options.reading.bits;
    if (isLinear || !plainBook(scan.census, kReal))
        scan = scanTree(grid.tree(), {.distinct = !isLinear, .survey = sizeof(T) > 1});
    // Active voxels may be as empty as inactive ones: then they have that very value.
    if (isFinite(grid.background())) scan.census.frequent = {{double(grid.background()), 0}};
    // Masks have nothing but true, which stays 1.
    volume.codeBook = std::is_same_v<T, bool>
                          ? CodeBook::integer(0)
                          : chooseBook(scan.census, kReal, options.reading, options.where);
    ErrorMeter meter(volume.codeBook, bulkMagnitude(scan.census));
    CodeCounts counts;
    takeCodes(codesOfTree(grid.tree(), volume.codeBook, meter, counts), counts, options, volume);
    takeBackground(grid, volume);
    if (volume.codeBook.isExact()) return;
    volume.valueMin = scan.census.min;
    volume.valueMax = scan.census.max;
    volume.codeError = meter.error();
    warnOfCodeError(options.where, volume, options.reading, options.listener);
}

// Writes the codes of active tiles; returns whether all are halves.
bool codeHalfTiles(const openvdb::FloatTree& tree, CodeTree::Tree& codes, CodeCounts& counts) {
    const CodeBook book = CodeBook::half();
    bool areHalves = true;
    forActiveTiles(codes, [&](const auto& tile) {
        const float value = tree.getValue(tile.getCoord());
        areHalves = areHalves && isFinite(value) && book.valueOf(book.codeOf(value)) == value;
        tile.setValue(areHalves ? book.codeOf(value) : Code{0});
        counts.add(0, *tile, tile.getVoxelCount());
    });
    return areHalves;
}

}  // namespace

bool fillFromHalves(const VdbHalves& halves, const GridCodesOptions& options, Volume& volume) {
    const openvdb::FloatTree& topology = halves.topology->tree();
    const std::vector<VdbLeaf>& leaves = halves.leaves.leaves();
    CodeCounts counts;
    auto codes =
        std::make_shared<CodeTree>(std::in_place, topology, Code{0}, openvdb::TopologyCopy());
    if (!codeHalfTiles(topology, codes->tree(), counts)) return false;
    std::atomic<bool> areSound = true;
    SharedProgress progress(options.listener);
    fillLeaves(codes->tree(), counts, [&](std::size_t, std::size_t i, Code* out) {
        if (i % kLeafRun == 0) progress.report(double(i) / double(leaves.size()));
        VdbLeaves::Values<std::uint16_t> room;
        const VdbLeaves::Mask mask = halves.leaves.maskOf(leaves[i]);
        const auto bits = halves.leaves.activeValues<std::uint16_t>(leaves[i], mask, room);
        if (bits.empty() && mask != VdbLeaves::Mask{}) areSound = false;
        if (!codesOfHalfBits(bits, out)) areSound = false;
    });
    if (!areSound) return false;
    volume.codeBook = CodeBook::half();
    takeCodes(std::move(codes), counts, options, volume);
    takeBackground(*halves.topology, volume);
    describeGrid(*halves.topology, options, volume);
    return true;
}

void fillFromGrid(openvdb::GridBase& grid, const GridCodesOptions& options, Volume& volume) {
    const bool known = grid.apply<ScalarGrids>([&](auto& typed) { fill(typed, options, volume); });
    if (!known) fail(options.where, "type " + options.type, "a scalar grid");
    describeGrid(grid, options, volume);
}

}  // namespace deltasplat
