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
#include "ingest/grids/file_leaves.h"
#include "ingest/grids/grid_errors.h"
#include "ingest/grids/grid_values.h"
#include "ingest/grids/scalar_grids.h"
#include "ingest/readers.h"
#include "ingest/values/float_kernels.h"
#include "number_text.h"

namespace deltasplat {
namespace {

[[noreturn]] void fail(const std::string& where, const std::string& got,
                       const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(where, got, expected));
}

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

// Fills the leaves of a tree, and counts their codes: codesOf(worker, i, room, out) writes those of
// the active voxels of leaf i, in the order of their places; where it returns false, no more are
// filled.
template <typename Room, typename CodesOf>
void fillLeaves(CodeTree::Tree& codes, CodeCounts& counts, const CodesOf& codesOf) {
    std::vector<CodeTree::Leaf*> leaves;
    codes.getNodes(leaves);
    std::atomic<bool> areSound = true;
    std::vector<std::unique_ptr<Room>> rooms(counts.workers());
    forLeafRuns(leaves.size(), counts.workers(),
                [&](std::size_t worker, std::size_t begin, std::size_t end) {
                    LeafRoom<CodeTree::Leaf> activeCodes;
                    if (!rooms[worker]) rooms[worker] = std::make_unique_for_overwrite<Room>();
                    for (std::size_t i = begin; i < end && areSound; ++i) {
                        CodeTree::Leaf& leaf = *leaves[i];
                        const bool isDense = leaf.isDense();
                        Code* const out = isDense ? leaf.buffer().data() : activeCodes.data();
                        if (!codesOf(worker, i, *rooms[worker], out)) {
                            areSound = false;
                            break;
                        }
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

template <typename Leaves>
std::shared_ptr<CodeTree> codesOfLeaves(const Leaves& leaves, const CodeBook& book,
                                        ErrorMeter& meter, CodeCounts& counts) {
    const BookEncoder encode(book);
    const bool exact = book.isExact();
    const auto& tree = leaves.tree();
    // OpenVDB's trees cannot be assigned, only made in place.
    std::shared_ptr<CodeTree> codes(
        new CodeTree(std::in_place, tree, Code{0}, openvdb::TopologyCopy()));
    std::vector<ErrorMeter::Part> parts(counts.workers(), ErrorMeter::Part(meter));
    using Room = typename Leaves::Room;
    fillLeaves<Room>(codes->tree(), counts,
                     [&](std::size_t worker, std::size_t i, Room& room, Code* out) {
                         const auto values = leaves.values(i, room);
                         if (values.size() != leaves[i].onVoxelCount()) return false;
                         encodeAll(book, encode, values, out);
                         for (std::size_t n = 0; !exact && n < values.size(); ++n)
                             parts[worker].add(double(values[n]), out[n]);
                         return true;
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
void describeGrid(const Grid& grid, const GridCodesOptions& options, Volume& volume) {
    volume.hasBackground = true;
    volume.background = double(grid.background());
    volume.type = options.type;
    volume.gridClass = openvdb::GridBase::gridClassToString(grid.getGridClass());
}

// Chooses a code book and turns values into codes of it.
// @param scan  of kNumbersAlone
template <typename Leaves>
void fillFromLeaves(const Leaves& leaves, GridScan scan, const GridCodesOptions& options,
                    Volume& volume) {
    using T = std::decay_t<decltype(leaves.tree().background())>;
    constexpr bool kReal = std::is_floating_point_v<T>;
    const bool isLinear = kReal && options.reading.bits;
    if (isLinear || !plainBook(scan.census, kReal))
        scan = scanLeaves(leaves, {.distinct = !isLinear, .survey = sizeof(T) > 1});
    const T background = leaves.tree().background();
    // Active voxels may be as empty as inactive ones: then they have that very value.
    if (isFinite(background)) scan.census.frequent = {{double(background), 0}};
    // Masks have nothing but true, which stays 1.
    volume.codeBook = std::is_same_v<T, bool>
                          ? CodeBook::integer(0)
                          : chooseBook(scan.census, kReal, options.reading, options.where);
    ErrorMeter meter(volume.codeBook, bulkMagnitude(scan.census));
    CodeCounts counts;
    takeCodes(codesOfLeaves(leaves, volume.codeBook, meter, counts), counts, options, volume);
    if (volume.codeBook.isExact()) return;
    volume.valueMin = scan.census.min;
    volume.valueMax = scan.census.max;
    volume.codeError = meter.error();
    warnOfCodeError(options.where, volume, options.reading, options.listener);
}

template <typename Grid>
void fill(Grid& grid, const GridCodesOptions& options, Volume& volume) {
    GridScan scan = scanLeaves(TreeLeaves(grid.tree()), kNumbersAlone);
    if constexpr (std::is_floating_point_v<typename Grid::ValueType>) {
        volume.replaced = scan.nonFinite;
        if (scan.nonFinite > 0) settleNonFinite(grid, scan, options);
        volume.fromLevelSet = makeFog(grid, options);
        if (volume.replaced > 0 || volume.fromLevelSet)
            scan = scanLeaves(TreeLeaves(grid.tree()), kNumbersAlone);
    }
    fillFromLeaves(TreeLeaves(grid.tree()), std::move(scan), options, volume);
    describeGrid(grid, options, volume);
}

// Writes the codes of active tiles; returns whether all are halves.
template <typename Tree>
bool codeHalfTiles(const Tree& tree, CodeTree::Tree& codes, CodeCounts& counts) {
    const CodeBook book = CodeBook::half();
    bool areHalves = true;
    forActiveTiles(codes, [&](const auto& tile) {
        const auto value = double(tree.getValue(tile.getCoord()));
        areHalves = areHalves && std::isfinite(value) && book.valueOf(book.codeOf(value)) == value;
        tile.setValue(areHalves ? book.codeOf(value) : Code{0});
        counts.add(0, *tile, tile.getVoxelCount());
    });
    return areHalves;
}

template <typename Tree>
bool fillFromHalves(const Tree& topology, const VdbLeaves& packed, const GridCodesOptions& options,
                    Volume& volume) {
    CodeCounts counts;
    auto codes =
        std::make_shared<CodeTree>(std::in_place, topology, Code{0}, openvdb::TopologyCopy());
    if (!codeHalfTiles(topology, codes->tree(), counts)) return false;
    const FileLeaves<Tree, std::uint16_t> leaves(topology, packed, 1, options.listener);
    using Room = typename decltype(leaves)::Room;
    std::atomic<bool> areFinite = true;
    // All leaves are looked at, so that what is damaged is said however many threads there are.
    fillLeaves<Room>(codes->tree(), counts, [&](std::size_t, std::size_t i, Room& room, Code* out) {
        const auto bits = leaves.values(i, room);
        if (!codesOfHalfBits(bits, out)) areFinite = false;
        return !leaves.areDamaged();
    });
    if (leaves.areDamaged()) throw DamagedLeaves(options.where);
    if (!areFinite) return false;
    volume.codeBook = CodeBook::half();
    takeCodes(std::move(codes), counts, options, volume);
    return true;
}

template <typename Tree>
bool fillFromNumbers(const Tree& topology, const VdbLeaves& packed, const GridCodesOptions& options,
                     Volume& volume) {
    // One to see what there is and one for codes; rarely one more.
    const FileLeaves<Tree> leaves(topology, packed, 2, options.listener);
    GridScan scan = scanLeaves(leaves, kNumbersAlone);
    if (leaves.areDamaged()) throw DamagedLeaves(options.where);
    if (scan.nonFinite > 0) return false;
    fillFromLeaves(leaves, std::move(scan), options, volume);
    // Each pass reads the file anew.
    if (leaves.areDamaged()) throw DamagedLeaves(options.where);
    return true;
}

}  // namespace

bool fillFromLeaves(const VdbValues& values, const GridCodesOptions& options, Volume& volume) {
    bool isFilled = false;
    values.topology->apply<ScalarGrids>([&](const auto& grid) {
        using T = typename std::decay_t<decltype(grid)>::ValueType;
        if constexpr (!std::is_same_v<T, bool>) {
            isFilled = values.areHalves
                           ? fillFromHalves(grid.tree(), values.leaves, options, volume)
                           : fillFromNumbers(grid.tree(), values.leaves, options, volume);
            if (isFilled) describeGrid(grid, options, volume);
        }
    });
    return isFilled;
}

void fillFromGrid(openvdb::GridBase& grid, const GridCodesOptions& options, Volume& volume) {
    const bool known = grid.apply<ScalarGrids>([&](auto& typed) { fill(typed, options, volume); });
    if (!known) fail(options.where, "type " + options.type, "a scalar grid");
}

}  // namespace deltasplat
