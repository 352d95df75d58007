// SPDX-License-Identifier: Apache-2.0
#include "diff/voxel_source.h"

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

#include "deltasplat/error.h"
#include "formats/vdb/grid_metadata.h"
#include "formats/vdb/vdb_leaves.h"
#include "volume/code_math.h"
#include "volume/code_tree.h"
#include "volume/grid_values.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

using openvdb::Coord;

constexpr double kWideStep = 0x1p32;

// Truncates towards 0, so parts share the value's sign, and differences cancel only if both are 0.
WideValue split(double value) {
    if (!std::isfinite(value)) return {value, 0};
    const double high = std::trunc(value / kWideStep) * kWideStep;
    return {high, value - high};
}

WideValue split(std::int64_t value) {
    constexpr std::int64_t kStep = std::int64_t{1} << 32;
    const std::int64_t high = value / kStep;
    return {double(high) * kWideStep, double(value % kStep)};
}

WideValue split(std::uint64_t value) {
    constexpr std::uint64_t kStep = std::uint64_t{1} << 32;
    const std::uint64_t high = value / kStep;
    return {double(high) * kWideStep, double(value % kStep)};
}

struct Decoder {
    std::shared_ptr<const std::vector<double>> table;  // [65536] values of codes; or null
    bool wide = false;
    bool isUnsigned = false;  // int64 holds the bits of uint64

    template <typename T>
    WideValue operator()(T stored) const {
        if constexpr (std::is_same_v<T, Code>) {
            const double value = (*table)[stored];
            return wide ? split(value) : WideValue{value, 0};
        } else if constexpr (std::is_same_v<T, std::int64_t>) {
            return isUnsigned ? split(std::uint64_t(stored)) : split(stored);
        } else {
            return wide ? split(double(stored)) : WideValue{double(stored), 0};
        }
    }
};

template <typename Tree>
class TreeReader : public VoxelReader {
  public:
    TreeReader(const Tree& tree, Decoder decode, std::optional<WideValue> inactive)
        : accessor_(tree), decode_(std::move(decode)), inactive_(inactive) {}

    int depthAt(const Coord& at) override { return accessor_.getValueDepth(at); }

    Sample sampleAt(const Coord& at) override {
        const bool active = accessor_.isValueOn(at);
        if (!active && inactive_) return {*inactive_, false};
        return {decode_(Stored(accessor_.getValue(at))), active};
    }

    bool readLeaf(const Coord& origin, BlockSamples& block) override {
        const auto* leaf = accessor_.probeConstLeaf(origin);
        if (leaf == nullptr) return false;
        const auto& mask = leaf->getValueMask();
        for (int word = 0; word < 8; ++word) {
            block.active[word] = mask.template getWord<std::uint64_t>(openvdb::Index(word));
        }
        if (decode_.wide) {
            decodeValues<true>(*leaf, block);
        } else {
            decodeValues<false>(*leaf, block);
        }
        if (inactive_ && !mask.isOn()) setInactive(block);
        return true;
    }

  private:
    using Leaf = typename Tree::LeafNodeType;
    // Mask grids store their states as values.
    using Stored = std::conditional_t<std::is_same_v<typename Tree::ValueType, openvdb::ValueMask>,
                                      bool, typename Tree::ValueType>;

    static auto valuesOf(const Leaf& leaf) {
        if constexpr (std::is_same_v<Stored, bool>) {
            return [&leaf](int i) -> Stored { return leaf.getValue(openvdb::Index(i)); };
        } else {
            const Stored* values = leaf.buffer().data();
            return [values](int i) { return values[i]; };
        }
    }

    // Splitting is decided per block, to keep the common loop short.
    template <bool kWide>
    void decodeValues(const Leaf& leaf, BlockSamples& block) const {
        const auto stored = valuesOf(leaf);
        for (int i = 0; i < BlockSamples::kVoxels; ++i) {
            if constexpr (kWide) {
                const WideValue value = decode_(stored(i));
                block.high[i] = value.high;
                block.low[i] = value.low;
            } else if constexpr (std::is_same_v<Stored, Code>) {
                block.high[i] = (*decode_.table)[stored(i)];
            } else {
                block.high[i] = double(stored(i));
            }
        }
    }

    void setInactive(BlockSamples& block) const {
        for (int i = 0; i < BlockSamples::kVoxels; ++i) {
            if ((block.active[i >> 6] >> (i & 63) & 1) != 0) continue;
            block.high[i] = inactive_->high;
            block.low[i] = inactive_->low;
        }
    }

    openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false> accessor_;
    Decoder decode_;
    std::optional<WideValue> inactive_;
};

template <typename T>
class PackedReader : public VoxelReader {
  public:
    PackedReader(const PackedGrid& packed, const PackedGrid::Tree<T>& nodes, bool wide)
        : packed_(packed), nodes_(nodes), decode_{nullptr, wide} {}

    int depthAt(const Coord& at) override { return nodes_.getValueDepth(at); }

    Sample sampleAt(const Coord& at) override {
        const T value = nodes_.getValue(at);
        const bool active = nodes_.isValueOn(at);
        if (active && !isFinite(value)) throw NeedsWholeGrid("tile");
        return {decode_(value), active};
    }

    bool readLeaf(const Coord& origin, BlockSamples& block) override {
        const auto* const leaf = nodes_.probeConstLeaf(origin);
        if (!leaf) return false;
        const std::vector<VdbLeaf>& leaves = packed_.leaves.leaves();
        if (!packed_.leaves.allValues(leaves[leaf->transientData()], nodes_.background(),
                                      leaves.size(), block.active, room_, values_.data()))
            throw NeedsWholeGrid("leaf");
        requireFinite(block.active);
        for (std::size_t i = 0; i < values_.size(); ++i) {
            if (!decode_.wide) {
                block.high[i] = double(values_[i]);
                continue;
            }
            const WideValue value = decode_(values_[i]);
            block.high[i] = value.high;
            block.low[i] = value.low;
        }
        return true;
    }

  private:
    // Active values must be finite.
    void requireFinite(const std::array<std::uint64_t, 8>& active) const {
        if constexpr (std::is_floating_point_v<T>) {
            if (std::all_of(values_.begin(), values_.end(), isFinite<T>)) return;
            for (std::size_t i = 0; i < values_.size(); ++i) {
                const bool isActive = (active[i / 64] >> (i % 64) & 1) != 0;
                if (isActive && !isFinite(values_[i])) throw NeedsWholeGrid("leaf");
            }
        }
    }

    const PackedGrid& packed_;
    const PackedGrid::Tree<T>& nodes_;  // an accessor would allocate leaf values
    Decoder decode_;
    VdbLeaves::BytesRoom room_;
    std::array<T, BlockSamples::kVoxels> values_;
};

template <typename Tree>
std::vector<Coord> regionsOf(const Tree& tree) {
    std::vector<Coord> regions;
    for (auto entry = tree.root().cbeginChildAll(); entry; ++entry) {
        regions.push_back(entry.getCoord());
    }
    return regions;
}

// Returns a copy of a tree shifted by `offset`.
template <typename Tree>
std::shared_ptr<const Tree> moved(const Tree& tree, const Coord& offset) {
    auto result = std::make_shared<Tree>(tree.background());
    openvdb::tree::ValueAccessor<Tree, /*IsSafe=*/false> to(*result);
    // Tiles first, because fill() may delete nodes that the accessor caches.
    for (const bool tiles : {true, false}) {
        auto from = tree.cbeginValueAll();
        if (tiles) from.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
        if (!tiles) from.setMinDepth(Tree::ValueAllCIter::LEAF_DEPTH);
        for (; from; ++from) {
            const bool active = from.isValueOn();
            typename Tree::ValueType value = *from;
            // A mask leaf has only states.
            if constexpr (std::is_same_v<typename Tree::BuildType, openvdb::ValueMask>) {
                value = active;
            }
            if (!active && value == tree.background()) continue;
            openvdb::CoordBBox box;
            from.getBoundingBox(box);
            box.translate(offset);
            if (tiles) {
                result->fill(box, value, active);
            } else if (active) {
                to.setValueOn(box.min(), value);
            } else {
                to.setValueOff(box.min(), value);
            }
        }
    }
    return result;
}

template <typename Use>
void withSource(const Volume& volume, const Use& use) {
    const TreeGrid& grid = volume.source()->grid;
    if (grid.apply<ScalarTrees>(use)) return;
    throw Error(ErrorCode::kInput, "grid \"" + volume.name() + "\"", "type " + grid.type(),
                "a scalar grid");
}

}  // namespace

void BlockSamples::fill(const Sample& sample, bool wide) {
    high.fill(sample.value.high);
    if (wide) low.fill(sample.value.low);
    active.fill(sample.active ? ~std::uint64_t{0} : 0);
}

VoxelSource::VoxelSource(const Volume& volume, bool wide, WideValue background, const Coord& offset)
    : background_(background) {
    // Only a source grid with a background has inactive values of its own.
    std::optional<WideValue> inactive;
    if (!volume.source() || !volume.hasBackground()) inactive = background;
    const auto readTree = [&](const auto& own, Decoder decode) {
        using Tree = std::decay_t<decltype(own)>;
        // The volume's tree outlives this source; a copy is owned.
        std::shared_ptr<const Tree> tree(&own, [](const Tree*) {});
        if (offset != Coord(0)) tree = moved(own, offset);
        regions_ = regionsOf(*tree);
        makeReader_ = [tree, decode = std::move(decode), inactive] {
            return std::make_unique<TreeReader<Tree>>(*tree, decode, inactive);
        };
    };
    if (volume.source() && volume.source()->packed) {
        if (offset != Coord(0)) throw NeedsWholeGrid(volume.name());
        const std::shared_ptr<const PackedGrid> packed = volume.source()->packed;
        const auto read = [&]<typename T>(const std::shared_ptr<T>& nodes) {
            regions_ = regionsOf(*nodes);
            makeReader_ = [packed, &tree = *nodes, wide] {
                using Value = typename T::ValueType;
                return std::make_unique<PackedReader<Value>>(*packed, tree, wide);
            };
        };
        std::visit(read, packed->nodes);
    } else if (volume.source()) {
        withSource(volume, [&](const auto& tree) {
            readTree(tree, {nullptr, wide, holdsUnsigned(volume)});
        });
    } else {
        readTree(
            volume.codes()->tree(),
            {std::make_shared<const std::vector<double>>(valuesOfCodes(volume.codeBook())), wide});
    }
}

namespace {

// Returns the background of a 64-bit integer volume; nothing for others.
std::optional<std::int64_t> wideBackground(const Volume& volume) {
    if (!volume.source()) return std::nullopt;
    if (volume.source()->packed) {
        const auto* const nodes =
            std::get_if<PackedGrid::Nodes<std::int64_t>>(&volume.source()->packed->nodes);
        return nodes ? std::optional((*nodes)->background()) : std::nullopt;
    }
    const auto* const tree = volume.source()->grid.as<openvdb::Int64Tree>();
    return tree ? std::optional(tree->background()) : std::nullopt;
}

}  // namespace

bool holdsInt64(const Volume& volume) {
    return wideBackground(volume).has_value();
}

WideValue backgroundOf(const Volume& volume, bool wide) {
    // A double cannot hold every 64-bit integer.
    if (const auto background = wideBackground(volume); volume.hasBackground() && background)
        return split(*background);
    return Decoder{nullptr, wide}(volume.background());
}

}  // namespace deltasplat
