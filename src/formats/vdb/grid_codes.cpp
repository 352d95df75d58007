// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/grid_codes.h"

#include <openvdb/tools/LevelSetUtil.h>
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "base/memory.h"
#include "base/progress.h"
#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/readers.h"
#include "formats/vdb/grid_metadata.h"
#include "formats/vdb/level_set_band.h"
#include "formats/vdb/vdb_file.h"
#include "volume/book_encoder.h"
#include "volume/code_counts.h"
#include "volume/code_tree.h"
#include "volume/float_kernels.h"
#include "volume/grid_values.h"
#include "volume/leaf_slices.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

/// Stands in for TreeLeaves with a grid whose leaf values are still packed in the file.
/// @tparam T       the grid's value type
/// @tparam Stored  its type in the file: T, or std::uint16_t for halves
template <typename T, typename Stored = T>
class FileLeaves {
  public:
    using Value = T;
    struct Room : VdbLeaves::Room<Stored> {
        LeafMask mask;  // of the last leaf whose values were asked for
    };

    /// @param passes    expected passes over all leaves
    /// @param listener  hears how far the passes are
    FileLeaves(const VdbValues& values, T background, int passes, const Listener& listener)
        : packed_(values.leaves),
          tiles_(values.tiles),
          background_(background),
          passes_(passes),
          progress_(listener) {}

    T background() const { return background_; }
    std::span<const T> tileValues() const { return tiles_.template values<T>(); }
    template <typename Use>
    void forTileRuns(const Use& use) const {
        use(std::span(tiles_.places()), tileValues());
    }
    std::size_t count() const { return packed_.leaves().size(); }
    openvdb::Coord place(std::size_t i) const {
        return openvdb::Coord(packed_.leaves()[i].origin.data());
    }
    const LeafMask& mask(std::size_t, const Room& room) const { return room.mask; }
    /// Returns no values for a damaged leaf.
    std::span<const Stored> values(std::size_t i, Room& room) const {
        if (i == 0) ++pass_;
        if (i % kLeafRun == 0) {
            const double done = pass_ - 1 + double(i) / double(count());
            progress_.report(std::min(1.0, done / passes_));
        }
        const auto values = packed_.activeValues(packed_.leaves()[i], room.mask, room);
        if (values) return *values;
        areDamaged_ = true;
        room.mask = {};
        return {};
    }
    bool areDamaged() const { return areDamaged_; }

    /// Returns a tree with tile codes, and with leaves (`filled`) that have no room for codes yet.
    std::shared_ptr<CodeTree> makeCodes(const std::vector<Code>& tileCodes,
                                        std::vector<CodeTree::Leaf*>& filled) const {
        std::vector<openvdb::Coord> places(count());
        for (std::size_t i = 0; i < places.size(); ++i) places[i] = place(i);
        auto codes = std::make_shared<CodeTree>();
        filled = addNodes(places, tiles_.places(), tileCodes, codes->tree());
        return codes;
    }
    /// Makes room in a leaf for the codes of the values that were asked for last.
    void makeRoom(const Room& room, CodeTree::Leaf& leaf) const {
        for (openvdb::Index x = 0; x < room.mask.size(); ++x)
            leaf.getValueMask().template getWord<std::uint64_t>(x) = room.mask[x];
        leaf.allocate();
        if (!leaf.isDense()) leaf.buffer().fill(Code{0});
    }

  private:
    const VdbLeaves& packed_;
    const VdbTiles& tiles_;
    T background_;
    int passes_;
    mutable std::atomic<int> pass_ = 0;
    mutable SharedProgress progress_;
    mutable std::atomic<bool> areDamaged_ = false;
};

}  // namespace

namespace {

// Replaces values that are not finite, or refuses them.
template <typename Tree>
void settleNonFinite(Tree& tree, const GridScan& range, const GridCodesOptions& options) {
    if (!options.reading.nanValue) {
        const std::string got = countText(range.nonFinite, "NaN or infinite active value") +
                                ", the first at (" + std::to_string(range.first.x()) + ", " +
                                std::to_string(range.first.y()) + ", " +
                                std::to_string(range.first.z()) + ")";
        throw NotFinite(
            ErrorCode::kInput,
            gotExpected(options.where, got, "finite values (`nanValue` VALUE replaces them)"));
    }
    if constexpr (std::is_same_v<typename Tree::ValueType, float>) {
        requireFloatNan(*options.reading.nanValue);
    }
    replaceNonFinite(tree, typename Tree::ValueType(*options.reading.nanValue));
    options.listener.warn(options.where + ": " +
                          countText(range.nonFinite, "NaN or infinite active value") +
                          " replaced by " + numberText(*options.reading.nanValue));
}

// Interface of a grid that OpenVDB's sdfToFogVolume needs.
template <typename T>
struct LevelSet {
    using TreeType = T;
    using ValueType = typename T::ValueType;

    T& tree() const { return *grid.as<T>(); }
    void setTree(std::shared_ptr<T> tree) { grid.tree = std::move(tree); }
    void setGridClass(openvdb::GridClass) {
        grid.metadata.insert(openvdb::GridBase::META_GRID_CLASS, std::string(kFogClass));
    }

    TreeGrid& grid;
};

// Turns a level set into fog, with a new tree, if that is asked for. Returns whether it did.
template <typename Tree>
bool makeFog(TreeGrid& grid, const GridCodesOptions& options) {
    if (gridClassOf(grid.metadata) != kLevelSetClass || !options.reading.levelSetToFog)
        return false;
    // Simulation caches label whole fields of distances as level sets, with a background of 0.
    const double width = double(grid.as<Tree>()->background());
    if (!(width > 0) || !std::isfinite(width)) {
        options.listener.warn(options.where + ": level set with background " + numberText(width) +
                              " kept as it is, not made fog");
        return false;
    }
    LevelSet<Tree> levelSet{grid};
    openvdb::tools::sdfToFogVolume(levelSet);
    return true;
}

// Returns whether more voxels of a level set became active.
bool completeLevelSet(TreeGrid& grid, const GridCodesOptions& options) {
    const auto& surface = options.reading.levelSetSurface;
    if (!surface || gridClassOf(grid.metadata) != kLevelSetClass) return false;
    const std::uint64_t added = completeBand(grid, *surface);
    if (added > 0) {
        options.listener.warn(options.where +
                              ": the level set's band ends too near to the surface; " +
                              countText(added, "voxel beside it goes on as its values do",
                                        "voxels beside it go on as their values do"));
    }
    return added > 0 || surface->isSolid;
}

// Moves the codes of a leaf's active voxels to their places.
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

// Makes a tree of the codes of leaves and tiles and counts the codes. encode(worker, values, codes)
// encodes the active values of a leaf. After damaged values, no more leaves are filled.
template <typename Leaves, typename Encode>
std::shared_ptr<CodeTree> fillCodes(const Leaves& leaves, const std::vector<Code>& tileCodes,
                                    CodeCounts& counts, const Encode& encode) {
    std::vector<CodeTree::Leaf*> filled;
    std::shared_ptr<CodeTree> codes = leaves.makeCodes(tileCodes, filled);
    auto code = tileCodes.begin();
    leaves.forTileRuns([&](const auto& places, const auto&) {
        for (const TilePlace& place : places) counts.add(0, *code++, place.voxels());
    });
    std::vector<CodeLeaf> described(filled.size());
    std::vector<std::unique_ptr<typename Leaves::Room>> rooms(counts.workers());
    const auto fill = [&](std::size_t worker, std::size_t i) {
        LeafRoom<CodeTree::Leaf> activeCodes;
        CodeTree::Leaf& leaf = *filled[i];
        const auto values = leaves.values(i, *rooms[worker]);
        // Blosc's temporary memory leaves gaps.
        expectPieces(std::size_t(1.5 * leafBytes<CodeTree::Leaf>()));
        leaves.makeRoom(*rooms[worker], leaf);
        if (values.empty() || values.size() != leaf.onVoxelCount()) return;
        const bool isDense = leaf.isDense();
        Code* const out = isDense ? leaf.buffer().data() : activeCodes.data();
        encode(worker, values, out);
        const std::span<const Code> written(out, values.size());
        described[i] = describeLeaf(leaf, written);
        counts.add(worker, written, described[i].lowest, described[i].highest);
        if (!isDense) spread(out, leaf);
    };
    forLeafRuns(filled.size(), counts.workers(),
                [&](std::size_t worker, std::size_t begin, std::size_t end) {
                    auto& room = rooms[worker];
                    if (!room) room = std::make_unique_for_overwrite<typename Leaves::Room>();
                    for (std::size_t i = begin; i < end && !leaves.areDamaged(); ++i)
                        fill(worker, i);
                });
    // Leaves without active voxels may lie outside of the active voxels' box.
    std::erase_if(described, [](const CodeLeaf& leaf) { return !leaf.leaf; });
    codes->noteLeaves(std::move(described));
    return codes;
}

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
    std::vector<ErrorMeter::Part> parts(counts.workers(), ErrorMeter::Part(meter));
    const auto encodeIn = [&](std::size_t worker, const auto& values, Code* out) {
        encodeAll(book, encode, values, out);
        if (book.isExact()) return;
        for (std::size_t n = 0; n < values.size(); ++n)
            parts[worker].add(double(values[n]), out[n]);
    };
    std::vector<Code> tileCodes;
    leaves.forTileRuns([&](const auto&, const auto& values) {
        tileCodes.resize(tileCodes.size() + values.size());
        encodeIn(0, values, tileCodes.data() + tileCodes.size() - values.size());
    });
    auto codes = fillCodes(leaves, tileCodes, counts, encodeIn);
    for (const ErrorMeter::Part& part : parts) meter.add(part);
    return codes;
}

void takeCodes(std::shared_ptr<CodeTree> codes, CodeCounts& counts, const GridCodesOptions& options,
               VolumeData& volume) {
    openvdb::CoordBBox active;
    if (codes->tree().evalActiveVoxelBoundingBox(active))
        volume.box = boxOfVoxels(active, options.where);
    volume.histogram = counts.take();
    volume.codes = std::move(codes);
    summarize(volume);
}

// Chooses a code book and encodes all values, by a scan of kNumbersAlone.
template <typename Leaves>
void fillFromLeaves(const Leaves& leaves, GridScan scan, const GridCodesOptions& options,
                    VolumeData& volume) {
    using T = typename Leaves::Value;
    constexpr bool kReal = std::is_floating_point_v<T>;
    const bool isLinear = kReal && options.reading.bits;
    if (isLinear || !plainBook(scan.census, kReal))
        scan = scanLeaves(leaves, {.distinct = !isLinear, .survey = sizeof(T) > 1});
    const T background = leaves.background();
    // Active voxels may be as empty as inactive ones: then they have exactly the background.
    if (isFinite(background)) scan.census.frequent = {{double(background), 0}};
    // Masks hold only true, which stays 1.
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

template <typename Tree>
void fill(const GridCodesOptions& options, TreeGrid& grid, VolumeData& volume) {
    GridScan scan = scanLeaves(TreeLeaves(*grid.as<Tree>()), kNumbersAlone);
    if constexpr (std::is_floating_point_v<typename Tree::ValueType>) {
        volume.replaced = scan.nonFinite;
        if (scan.nonFinite > 0) settleNonFinite(*grid.as<Tree>(), scan, options);
        volume.fromLevelSet = makeFog<Tree>(grid, options);
        const bool isCompleted = !volume.fromLevelSet && completeLevelSet(grid, options);
        if (volume.replaced > 0 || volume.fromLevelSet || isCompleted)
            scan = scanLeaves(TreeLeaves(*grid.as<Tree>()), kNumbersAlone);
    }
    const Tree& tree = *grid.as<Tree>();
    fillFromLeaves(TreeLeaves(tree), std::move(scan), options, volume);
    describeGrid(double(tree.background()), grid.metadata, options, volume);
}

// Returns the codes of tiles, or nothing if a value is no half.
template <typename T>
std::optional<std::vector<Code>> codesOfHalfTiles(std::span<const T> tiles) {
    std::vector<Code> codes(tiles.size());
    if (tiles.empty()) return codes;
    const std::vector<float> values(tiles.begin(), tiles.end());
    if (!std::equal(values.begin(), values.end(), tiles.begin())) return std::nullopt;
    const FloatFacts facts = factsOf(values);
    if (!facts.isFinite || !facts.isHalf) return std::nullopt;
    codesOfHalves(values, codes.data());
    return codes;
}

template <typename T>
bool fillFromHalves(const VdbValues& values, T background, const GridCodesOptions& options,
                    VolumeData& volume) {
    const FileLeaves<T, std::uint16_t> leaves(values, background, 1, options.listener);
    const auto tileCodes = codesOfHalfTiles(leaves.tileValues());
    if (!tileCodes) return false;
    CodeCounts counts;
    std::atomic<bool> areFinite = true;
    auto codes =
        fillCodes(leaves, *tileCodes, counts, [&](std::size_t, const auto& bits, Code* out) {
            if (!codesOfHalfBits(bits, out)) areFinite = false;
        });
    if (leaves.areDamaged()) throw DamagedLeaves(options.where);
    if (!areFinite) return false;
    volume.codeBook = CodeBook::half();
    takeCodes(std::move(codes), counts, options, volume);
    return true;
}

template <typename T>
bool fillFromNumbers(const VdbValues& values, T background, const GridCodesOptions& options,
                     VolumeData& volume) {
    // One pass to scan and one for codes; rarely one more.
    const FileLeaves<T> leaves(values, background, 2, options.listener);
    GridScan scan = scanLeaves(leaves, kNumbersAlone);
    if (leaves.areDamaged()) throw DamagedLeaves(options.where);
    if (scan.nonFinite > 0) return false;
    fillFromLeaves(leaves, std::move(scan), options, volume);
    // The second pass reads the file anew.
    if (leaves.areDamaged()) throw DamagedLeaves(options.where);
    return true;
}

}  // namespace

IndexBox boxOfVoxels(const openvdb::CoordBBox& active, const std::string& where) {
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
    if (!fits) {
        refuseInput(where, "active voxels spread over " + numberText(voxels) + " places",
                    "indices within 2^30 of 0");
    }
    return box;
}

void describeGrid(double background, const VdbMetadata& metadata, const GridCodesOptions& options,
                  VolumeData& volume) {
    volume.hasBackground = true;
    volume.background = background;
    volume.type = options.type;
    volume.gridClass = gridClassOf(metadata);
}

bool fillFromLeaves(const VdbValues& values, const GridCodesOptions& options, VolumeData& volume) {
    const auto fillWith = [&](const auto background) {
        const bool isFilled = values.areHalves
                                  ? fillFromHalves(values, background, options, volume)
                                  : fillFromNumbers(values, background, options, volume);
        if (isFilled) describeGrid(double(background), values.metadata, options, volume);
        return isFilled;
    };
    return std::visit(fillWith, values.background);
}

void fillFromGrid(TreeGrid& grid, const GridCodesOptions& options, VolumeData& volume) {
    const bool known = grid.apply<ScalarTrees>(
        [&](const auto& tree) { fill<std::decay_t<decltype(tree)>>(options, grid, volume); });
    if (!known) refuseInput(options.where, "type " + options.type, "a scalar grid");
}

}  // namespace deltasplat
