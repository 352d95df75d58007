// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/volume_grid.h"

#include <openvdb/io/Compression.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/error.h"
#include "deltasplat/openvdb_grid.h"
#include "formats/delta/delta_format.h"
#include "formats/dense/dense_layout.h"
#include "formats/readers.h"
#include "formats/vdb/grid_metadata.h"
#include "formats/vdb/grid_volume.h"
#include "formats/vdb/written_grid.h"
#include "volume/code_math.h"
#include "volume/code_tree.h"
#include "volume/grid_values.h"
#include "volume/placement.h"
#include "volume/tree_from_codes.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"
#include "volume/value_cast.h"
#include "volume/vdb_transform.h"

namespace deltasplat {

namespace {

/// Source of TreeWriter for codes: writes their values for a tree T of OpenVDB without making one.
template <typename T>
class CodeValues {
  public:
    using Tree = CodeTree::Tree;
    using Written = T;
    using Leaf = CodeTree::Leaf;
    using Value = typename Written::ValueType;

    CodeValues(std::shared_ptr<const CodeTree> codes, const CodeBook& book, double background)
        : codes_(std::move(codes)), background_(valueAs<Value>(background)) {
        for (const double value : valuesOfCodes(book)) {
            values_.push_back(valueAs<Value>(value));
            if constexpr (ToHalf::isReal) halves_.push_back(ToHalf::convert(Value(values_.back())));
        }
    }

    const Tree& tree() const { return codes_->tree(); }
    Value background() const { return background_; }
    Value ofTile(Code stored, bool active) const {
        return active ? Value(values_[stored]) : background_;
    }
    LeafNote appendLeaf(const Leaf& leaf, bool half, std::string& to) const {
        constexpr std::int8_t kKind = openvdb::io::NO_MASK_OR_INACTIVE_VALS;
        appendBytes(kKind, to);
        return {kKind, ToHalf::isReal && half ? appendActive(leaf, halves_, half, to)
                                              : appendActive(leaf, values_, false, to)};
    }
    void appendBools(const Leaf& leaf, std::string& to) const {
        typename Leaf::NodeMaskType values(background_);
        for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel)
            values.set(voxel.pos(), values_[*voxel]);
        appendBytes(values, to);
    }

  private:
    using ToHalf = openvdb::io::RealToHalf<Value>;
    // Avoids the packed bits of vector<bool>.
    using Kept = std::conditional_t<std::is_same_v<Value, bool>, std::uint8_t, Value>;

    template <typename Stored>
    static std::int64_t appendActive(const Leaf& leaf, const std::vector<Stored>& table, bool half,
                                     std::string& to) {
        std::array<Stored, Leaf::SIZE> values;
        const Code* const codes = leaf.buffer().data();
        std::size_t count = 0;
        if (leaf.isDense()) {
            for (; count < values.size(); ++count) values[count] = table[codes[count]];
        } else {
            forBits(leaf.getValueMask(), [&](std::size_t i) { values[count++] = table[codes[i]]; });
        }
        return appendStored(values.data(), count, half, to);
    }

    std::shared_ptr<const CodeTree> codes_;
    Value background_;
    std::vector<Kept> values_;                    // per code
    std::vector<typename ToHalf::HalfT> halves_;  // per code, for real values
};

template <typename T>
bool isHalf(T value) {
    const auto back = T(float(openvdb::math::half(float(value))));
    return back == value || value != value;
}

template <typename T>
bool areHalves(const Volume& volume, double background) {
    if (!isHalf(valueAs<T>(background))) return false;
    for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
        if (volume.histogram()[code] > 0 &&
            !isHalf(valueAs<T>(volume.codeBook().valueOf(Code(code)))))
            return false;
    }
    return true;
}

template <typename Leaf>
bool isHalfLeaf(const Leaf& leaf, bool inactiveOnly) {
    if (inactiveOnly) {
        for (auto voxel = leaf.cbeginValueOff(); voxel; ++voxel) {
            if (!isHalf(*voxel)) return false;
        }
        return true;
    }
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        if (!isHalf(leaf.getValue(i))) return false;
    }
    return true;
}

// @param inactiveOnly  skips active voxels of leaves
template <typename Tree>
bool survives(const Tree& tree, bool inactiveOnly) {
    // Background and inactive values are stored as halves, too.
    if (!isHalf(tree.background())) return false;
    auto tile = tree.cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (!isHalf(*tile)) return false;
    }
    std::vector<const typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    std::atomic<bool> all = true;
    forLeafRuns(leaves.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && all; ++i) {
            if (!isHalfLeaf(*leaves[i], inactiveOnly)) all = false;
        }
    });
    return all;
}

}  // namespace

bool survivesHalf(const TreeGrid& grid, const Volume* volume) {
    bool all = false;
    grid.apply<TreeTypes<openvdb::FloatTree, openvdb::DoubleTree>>([&](const auto& tree) {
        using Value = typename std::decay_t<decltype(tree)>::ValueType;
        const bool isCounted = volume && volume->codeBook().isExact();
        all = (!isCounted || areHalves<Value>(*volume, double(tree.background()))) &&
              survives(tree, isCounted);
    });
    return all;
}

bool survivesHalf(const Volume& volume, const std::string& type, double background) {
    if (type == "float") return areHalves<float>(volume, background);
    return type == "double" && areHalves<double>(volume, background);
}

namespace {

using openvdb::GridBase;

bool isGridType(const std::string& type) {
    const auto types = {"float", "half", "double", "int32", "int64", "bool", "mask"};
    return std::find(types.begin(), types.end(), type) != types.end();
}

// Returns the grid type of a volume that has none of OpenVDB's types.
std::string smallestType(const ValueFacts& facts) {
    if (facts.fit(RawType::kFloat32)) return "float";
    if (facts.fit(RawType::kInt32)) return "int32";
    return facts.doubleError == 0 ? "double" : "int64";
}

std::shared_ptr<openvdb::TreeBase> fromCodes(const Volume& volume, const std::string& type) {
    std::shared_ptr<openvdb::TreeBase> made;
    const double background = volume.hasBackground() ? volume.background() : 0;
    applyType(ScalarTrees(), type, [&]<typename Tree>(std::type_identity<Tree>) {
        made = treeFromCodes<Tree>(volume.codes()->tree(), volume.codeBook(),
                                   valueAs<typename Tree::ValueType>(background));
    });
    return made;
}

// Makes a tree of the same active voxels and tiles with converted values.
template <typename Made, typename Tree>
std::shared_ptr<Made> converted(const Tree& tree) {
    using T = typename Made::ValueType;
    auto made = std::make_shared<Made>(tree, T(0), openvdb::TopologyCopy());
    std::vector<const typename Tree::LeafNodeType*> sources;
    std::vector<typename Made::LeafNodeType*> leaves;
    tree.getNodes(sources);
    made->getNodes(leaves);
    forLeafRuns(leaves.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            T* values = leaves[i]->buffer().data();
            for (auto voxel = sources[i]->cbeginValueOn(); voxel; ++voxel)
                values[voxel.pos()] = T(*voxel);
        }
    });
    forActiveTiles(*made,
                   [&](const auto& tile) { tile.setValue(T(tree.getValue(tile.getCoord()))); });
    return made;
}

// The tree of a dense source may have a wider type than its values need.
std::shared_ptr<openvdb::TreeBase> fromSource(const TreeGrid& source, const std::string& type) {
    if (type == source.type()) return source.tree;
    std::shared_ptr<openvdb::TreeBase> made;
    using Wide = TreeTypes<openvdb::DoubleTree, openvdb::Int64Tree, openvdb::Int32Tree>;
    using Narrow = TreeTypes<openvdb::FloatTree, openvdb::Int32Tree, openvdb::DoubleTree>;
    source.apply<Wide>([&](const auto& tree) {
        applyType(Narrow(), type,
                  [&]<typename Made>(std::type_identity<Made>) { made = converted<Made>(tree); });
    });
    return made;
}

VdbMetadata metadataOf(const Volume& volume) {
    VdbMetadata metadata;
    metadata.insert(GridBase::META_GRID_NAME, volume.name());
    metadata.insert(GridBase::META_GRID_CREATOR, std::string("deltasplat " DELTASPLAT_VERSION));
    metadata.insert(GridBase::META_GRID_CLASS, volume.gridClass());
    metadata.insert(GridBase::META_GRID_CLASS, gridClassOf(metadata));
    if (!volume.hasBackground()) {
        metadata.insert(kSourceTypeKey, volume.type());
        metadata.insert(kBoxMinKey, volume.box().min);
        metadata.insert(kBoxMaxKey, volume.box().max);
    }
    if (!volume.space().empty()) metadata.insert(kSpaceKey, volume.space());
    if (!volume.lengthUnit().empty()) metadata.insert(kLengthUnitKey, volume.lengthUnit());
    if (volume.labels()) metadata.insert(kLabelsKey, labelText(*volume.labels()));
    return metadata;
}

std::shared_ptr<const WrittenTree> writtenTree(const Volume& volume, const std::string& type,
                                               double background) {
    std::shared_ptr<const WrittenTree> written;
    applyType(ScalarTrees(), type, [&]<typename Tree>(std::type_identity<Tree>) {
        using Values = CodeValues<Tree>;
        written = std::make_shared<const TreeWriter<Values>>(
            Values(volume.codes(), volume.codeBook(), background));
    });
    return written;
}

}  // namespace

Volume withHoldableUnit(Volume volume) {
    const double own = millimetresIn(volume.lengthUnit());
    if (own == 0 || hasMap(volume.worldFromIndex())) return volume;
    for (const char* const unit : {"mm", "um", "nm", "pm"}) {
        const double factor = own / millimetresIn(unit);
        glm::dmat4 scaled = volume.worldFromIndex();
        scaleLengths(scaled, factor);
        if (!(factor > 1) || !hasMap(scaled)) continue;
        return volume.withPlace(scaled, volume.space(), unit);
    }
    return volume;
}

std::string gridTypeOf(const Volume& volume) {
    const bool keepsType = volume.hasBackground() && isGridType(volume.type());
    if (!keepsType) return smallestType(factsOf(volume));
    return volume.type() == "half" ? "float" : volume.type();
}

WrittenGrid writtenCodes(const Volume& volume, const std::string& type, double background) {
    return {volume.name(), metadataOf(volume), makeMap(volume.worldFromIndex()),
            writtenTree(volume, type, background)};
}

TreeGrid gridOf(const Volume& volume) {
    if (volume.source() && volume.hasBackground()) {
        TreeGrid grid = volume.source()->grid;
        // The volume's own place counts, because it may be in another unit.
        if (matrixOf(*grid.map) != volume.worldFromIndex())
            grid.map = makeMap(volume.worldFromIndex());
        if (!volume.lengthUnit().empty()) grid.metadata.insert(kLengthUnitKey, volume.lengthUnit());
        if (volume.labels()) grid.metadata.insert(kLabelsKey, labelText(*volume.labels()));
        return grid;
    }
    const std::string type = gridTypeOf(volume);
    return {volume.source() ? fromSource(volume.source()->grid, type) : fromCodes(volume, type),
            metadataOf(volume), makeMap(volume.worldFromIndex())};
}

namespace {

// Whether reading changes a grid: level sets become fog or get a surface's voxels, NaN is replaced.
bool isChanged(const openvdb::GridBase& grid, const ReadOptions& options) {
    const bool isReal = grid.isType<openvdb::FloatGrid>() || grid.isType<openvdb::DoubleGrid>();
    const bool isLevelSet = grid.getGridClass() == openvdb::GRID_LEVEL_SET;
    const bool becomesOther = isLevelSet && (options.levelSetToFog || options.levelSetSurface);
    return isReal && (options.nanValue || becomesOther);
}

}  // namespace

Volume makeVolume(const openvdb::GridBase::ConstPtr& grid, const ReadOptions& options,
                  const Listener& listener) {
    const DefaultFloats floats;
    const std::string where = "OpenVDB grid";
    if (!grid) throw Error(ErrorCode::kUsage, where, "none", "a grid");
    openvdb::initialize();
    requireFiniteNan(options);
    const TreeGrid given = fromOpenVdb(grid);
    if (isDeltaGrid(given)) {
        throw Error(ErrorCode::kUsage, where, "the differences of a delta grid",
                    "the volume itself: readVolume reads a delta grid's file");
    }
    const bool changes = isChanged(*grid, options);
    if (changes) requireMemory(where, double(grid->memUsage()));
    TreeGrid own = given;
    if (changes) own.tree = own.tree->copy();
    VolumeData volume = volumeOfGrid(std::move(own), {listener, where, given.type(), options});
    volume.name = given.name();
    if (volume.source && !changes) {
        SourceGrid source = *volume.source;
        source.given = grid;
        volume.source = std::make_shared<const SourceGrid>(std::move(source));
    }
    listener.report(1);
    return Volume(std::move(volume));
}

openvdb::GridBase::ConstPtr makeGrid(const Volume& volume) {
    const DefaultFloats floats;
    if (!volume.codes()) {
        throw Error(ErrorCode::kUsage, "OpenVDB grid to make", "a volume without voxels",
                    "one that was read or made");
    }
    const bool wasGiven = volume.source() && volume.source()->given && volume.hasBackground();
    return wasGiven ? volume.source()->given : toOpenVdb(gridOf(volume));
}

}  // namespace deltasplat
