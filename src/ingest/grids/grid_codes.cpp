// SPDX-License-Identifier: Apache-2.0
#include "ingest/grids/grid_codes.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetUtil.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "deltasplat/error.h"
#include "ingest/codes/book_encoder.h"
#include "ingest/codes/code_statistics.h"
#include "ingest/codes/code_tree.h"
#include "ingest/codes/error_meter.h"
#include "ingest/grids/grid_values.h"
#include "ingest/grids/not_finite.h"
#include "ingest/grids/scalar_grids.h"
#include "ingest/readers.h"
#include "number_text.h"

namespace deltasplat {
namespace {

[[noreturn]] void fail(const std::string& where, const std::string& got,
                       const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(where, got, expected));
}

// Whether any value is NaN or infinite, active or not: there hardly ever is, and this is told soon.
template <typename Tree>
bool hasNonFinite(Tree& tree) {
    using T = typename Tree::ValueType;
    std::vector<typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    std::atomic<bool> found = false;
    forLeafRuns(leaves.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && !found; ++i) {
            const T* values = leaves[i]->buffer().data();
            bool areFinite = true;
            for (openvdb::Index n = 0; n < Tree::LeafNodeType::SIZE; ++n)
                areFinite &= std::fabs(values[n]) <= std::numeric_limits<T>::max();
            if (!areFinite) found = true;
        }
    });
    forActiveTiles(tree, [&](const auto& tile) {
        if (!isFinite(*tile)) found = true;
    });
    return found;
}

template <typename Grid>
std::uint64_t settleNonFinite(Grid& grid, const GridCodesOptions& options) {
    if (!hasNonFinite(grid.tree())) return 0;
    const GridScan range = scanTree(grid.tree(), {.distinct = false, .survey = false});
    if (range.nonFinite == 0) return 0;
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
    return range.nonFinite;
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

template <typename Tree>
std::shared_ptr<CodeTree> codesOfTree(Tree& tree, const CodeBook& book, ErrorMeter& meter) {
    const BookEncoder encode(book);
    const bool exact = book.isExact();
    using SourceLeaf = typename Tree::LeafNodeType;
    // OpenVDB's trees cannot be assigned, only made in place.
    std::shared_ptr<CodeTree> codes(
        new CodeTree(std::in_place, tree, Code{0}, openvdb::TopologyCopy()));
    std::vector<SourceLeaf*> sources;
    std::vector<CodeTree::Leaf*> targets;
    tree.getNodes(sources);
    codes->tree().getNodes(targets);
    forLeafRuns(sources.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        ErrorMeter::Part part(meter);
        for (std::size_t i = begin; i < end; ++i) {
            Code* out = targets[i]->buffer().data();
            forActiveVoxels(*sources[i], [&](openvdb::Index n, const auto& value) {
                out[n] = encode(double(value));
                if (!exact) part.add(double(value), out[n]);
            });
        }
        meter.add(part);
    });
    forActiveTiles(codes->tree(), [&](const auto& tile) {
        const auto value = double(tree.getValue(tile.getCoord()));
        tile.setValue(encode(value));
        ErrorMeter::Part part(meter);
        if (!exact) part.add(value, *tile);
        meter.add(part);
    });
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

template <typename Grid>
void fill(Grid& grid, const GridCodesOptions& options, Volume& volume) {
    using T = typename Grid::ValueType;
    if constexpr (std::is_floating_point_v<T>) {
        volume.replaced = settleNonFinite(grid, options);
        volume.fromLevelSet = makeFog(grid, options);
    }
    constexpr bool kReal = std::is_floating_point_v<T>;
    const bool isLinear = kReal && options.reading.bits;
    GridScan scan = scanTree(grid.tree(), {.distinct = false, .survey = false});
    if (isLinear || !plainBook(scan.census, kReal))
        scan = scanTree(grid.tree(), {.distinct = !isLinear, .survey = sizeof(T) > 1});
    // Active voxels may be as empty as inactive ones: then they have that very value.
    if (isFinite(grid.background())) scan.census.frequent = {{double(grid.background()), 0}};
    // Masks have nothing but true, which stays 1.
    volume.codeBook = std::is_same_v<T, bool>
                          ? CodeBook::integer(0)
                          : chooseBook(scan.census, kReal, options.reading, options.where);
    volume.hasBackground = true;
    volume.background = double(grid.background());
    ErrorMeter meter(volume.codeBook, bulkMagnitude(scan.census));
    auto codes = codesOfTree(grid.tree(), volume.codeBook, meter);
    volume.box = boxOf(codes->tree(), options.where);
    volume.histogram = histogramOf(codes->tree());
    volume.codes = std::move(codes);
    summarize(volume);
    if (volume.codeBook.isExact()) return;
    volume.valueMin = scan.census.min;
    volume.valueMax = scan.census.max;
    volume.codeError = meter.error();
    warnOfCodeError(options.where, volume, options.reading, options.listener);
}

}  // namespace

void fillFromGrid(openvdb::GridBase& grid, const GridCodesOptions& options, Volume& volume) {
    const bool known = grid.apply<ScalarGrids>([&](auto& typed) { fill(typed, options, volume); });
    if (!known) fail(options.where, "type " + options.type, "a scalar grid");
    volume.type = options.type;
    volume.gridClass = openvdb::GridBase::gridClassToString(grid.getGridClass());
}

}  // namespace deltasplat
