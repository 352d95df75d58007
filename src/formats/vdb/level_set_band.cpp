// SPDX-License-Identifier: Apache-2.0
// Based on: the sign convention of OpenVDB's level sets (Museth, VDB: High-Resolution Sparse
// Volumes with Dynamic Topology, 2013, section 4): inactive voxels and tiles outside of the narrow
// band are inside the surface if they are negative.
#include "formats/vdb/level_set_band.h"

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "volume/grid_values.h"

namespace deltasplat {
namespace {

using openvdb::Coord;

// Voxels needed inside and outside, found by trying: oblique rays go 1.7 voxels deep between two.
constexpr double kDepth = 1.9;
constexpr double kHeight = 1.5;
// Depth of a solid, whose cut shows all inside: gradients at the surface must not see the filling.
constexpr double kSolidDepth = 5;
// Depth of the filling's values: more than one voxel's values span in any direction.
constexpr double kFilledDepth = 9;
// A voxel at the end of the band is near enough to a needed voxel if it is at most this less deep.
constexpr double kStep = 0.5;
// Least distance from the surface at 0 of a voxel whose side is known, in steps.
constexpr double kLeastShare = 1e-3;
// Layers are added one by one; a layer is 0.58 voxels thick along a diagonal.
constexpr int kMostLayers = 12;

const std::array<Coord, 6> kSides{Coord(-1, 0, 0), Coord(1, 0, 0),  Coord(0, -1, 0),
                                  Coord(0, 1, 0),  Coord(0, 0, -1), Coord(0, 0, 1)};

Coord besideLeaf(const Coord& origin, std::size_t side) {
    const Coord& step = kSides[side];
    return origin.offsetBy(8 * step.x(), 8 * step.y(), 8 * step.z());
}

bool isAny(const LeafMask& mask) {
    return std::any_of(mask.begin(), mask.end(), [](std::uint64_t word) { return word != 0; });
}

// Returns the voxels of a leaf that touch one of kSides.
LeafMask faceOf(const LeafMask& mask, std::size_t side) {
    constexpr std::uint64_t kFirstRow = 0xff, kFirstColumn = 0x0101010101010101;
    constexpr std::array<std::uint64_t, 6> kKept{~std::uint64_t{0}, ~std::uint64_t{0},
                                                 kFirstRow,         kFirstRow << 56,
                                                 kFirstColumn,      kFirstColumn << 7};
    LeafMask face{};
    for (std::size_t x = 0; x < 8; ++x) {
        const bool isIn = side == 0 ? x == 0 : side == 1 ? x == 7 : true;
        if (isIn) face[x] = mask[x] & kKept[side];
    }
    return face;
}

// Adds the voxels of a leaf that lie beside voxels of its neighbour on one of kSides.
void addFrom(const LeafMask& other, std::size_t side, LeafMask& mask) {
    const LeafMask face = faceOf(other, side ^ 1);
    switch (side) {
        case 0:
            mask[0] |= face[7];
            return;
        case 1:
            mask[7] |= face[0];
            return;
        default:
            break;
    }
    for (std::size_t x = 0; x < 8; ++x) {
        mask[x] |= side == 2   ? face[x] >> 56
                   : side == 3 ? face[x] << 56
                   : side == 4 ? face[x] >> 7
                               : face[x] << 7;
    }
}

// Returns the voxels of a leaf that lie beside some voxels of `mask`.
LeafMask besides(const LeafMask& mask) {
    constexpr std::uint64_t kNotFirst = 0xfefefefefefefefe, kNotLast = 0x7f7f7f7f7f7f7f7f;
    LeafMask beside{};
    for (std::size_t x = 0; x < 8; ++x) {
        const std::uint64_t word = mask[x];
        beside[x] |= (word << 1 & kNotFirst) | (word >> 1 & kNotLast) | word << 8 | word >> 8;
        if (x > 0) beside[x - 1] |= word;
        if (x < 7) beside[x + 1] |= word;
    }
    return beside;
}

template <typename Tree>
class BandCompleter {
  public:
    // @param voxelSize  in world units, which distances use as well
    BandCompleter(Tree& tree, const LevelSetSurface& surface, double voxelSize)
        : tree_(tree),
          voxelSize_(voxelSize),
          isovalue_(surface.isovalue),
          depth_(surface.isSolid ? kSolidDepth : kDepth) {}

    std::uint64_t addLayers() {
        // Voxels too far away for a volume are refused later.
        openvdb::CoordBBox box;
        constexpr int kFarthest = 1 << 30;
        if (!tree_.evalActiveVoxelBoundingBox(box) ||
            !openvdb::CoordBBox(Coord(-kFarthest), Coord(kFarthest)).isInside(box))
            return 0;
        step_ = largestStep();
        if (!(step_ > 0)) return 0;
        for (int layer = 0; layer < kMostLayers && addLayer(); ++layer) continue;
        return beside_;
    }

    void fillInside() {
        const Value deepest(isovalue_ - kFilledDepth * step_);
        for (auto value = tree_.beginValueOff(); value; ++value) {
            if (!(*value < 0)) continue;
            value.setValue(std::min(*value, deepest));
            value.setActiveState(true);
        }
    }

  private:
    using Value = typename Tree::ValueType;
    using Leaf = typename Tree::LeafNodeType;
    using Accessor = openvdb::tree::ValueAccessor<const Tree>;

    // Voxels of a leaf that are near to voxels that may be needed.
    struct Near {
        LeafMask toInside{};   // active voxels that need neighbours inside
        LeafMask toOutside{};  // active voxels that need neighbours outside
        const LeafMask& of(bool isInside) const { return isInside ? toInside : toOutside; }
    };
    struct Added {
        openvdb::Index place;
        Value value;
    };

    // Returns the largest change from one active voxel to the next along an axis. A band thinner
    // than two such steps does not show all changes: then a voxel's size is the least.
    double largestStep() const {
        std::vector<const Leaf*> leaves;
        tree_.getNodes(leaves);
        std::vector<double> most(leaves.size(), 0);
        std::vector<openvdb::Vec2d> ranges(leaves.size(), openvdb::Vec2d(INFINITY, -INFINITY));
        parallelFor(leaves.size(), [&](std::size_t i) {
            const Value* values = leaves[i]->buffer().data();
            for (auto voxel = leaves[i]->cbeginValueOn(); voxel; ++voxel) {
                const openvdb::Index n = voxel.pos();
                const auto value = double(values[n]);
                if (std::isfinite(value))
                    ranges[i] = {std::min(ranges[i][0], value), std::max(ranges[i][1], value)};
                const auto compare = [&](openvdb::Index other) {
                    if (!leaves[i]->isValueOn(other)) return;
                    const double change = std::abs(double(values[other]) - value);
                    if (std::isfinite(change)) most[i] = std::max(most[i], change);
                };
                if (n / 64 < 7) compare(n + 64);
                if (n / 8 % 8 < 7) compare(n + 8);
                if (n % 8 < 7) compare(n + 1);
            }
        });
        if (most.empty()) return 0;
        const double step = *std::max_element(most.begin(), most.end());
        double low = INFINITY, high = -INFINITY;
        for (const openvdb::Vec2d& range : ranges) {
            low = std::min(low, range[0]);
            high = std::max(high, range[1]);
        }
        return high - low < 2 * step ? std::max(step, voxelSize_) : step;
    }

    void findNear() {
        leaves_.clear();
        tree_.getNodes(leaves_);
        near_.assign(leaves_.size(), {});
        const double low = isovalue_ - (depth_ - kStep) * step_;
        const double high = isovalue_ + (kHeight - kStep) * step_;
        parallelFor(leaves_.size(), [&](std::size_t i) {
            leaves_[i]->setTransientData(openvdb::Index32(i));
            const Value* values = leaves_[i]->buffer().data();
            for (auto voxel = leaves_[i]->cbeginValueOn(); voxel; ++voxel) {
                const openvdb::Index n = voxel.pos();
                const std::uint64_t bit = std::uint64_t{1} << n % 64;
                if (double(values[n]) >= low) near_[i].toInside[n / 64] |= bit;
                if (double(values[n]) <= high) near_[i].toOutside[n / 64] |= bit;
            }
        });
    }

    // Adds leaves of inactive voxels where voxels are needed. Returns whether any was missing.
    bool addLeaves() {
        std::vector<Coord> missing;
        const Accessor accessor(tree_);
        for (std::size_t i = 0; i < leaves_.size(); ++i) {
            for (std::size_t side = 0; side < kSides.size(); ++side) {
                const Coord origin = besideLeaf(leaves_[i]->origin(), side);
                const bool isEmpty = !isAny(faceOf(near_[i].toInside, side)) &&
                                     !isAny(faceOf(near_[i].toOutside, side));
                if (isEmpty || accessor.probeConstLeaf(origin)) continue;
                Value value;
                if (accessor.probeValue(origin, value)) continue;
                if (isAny(faceOf(near_[i].of(value < 0), side))) missing.push_back(origin);
            }
        }
        for (const Coord& origin : missing) tree_.touchLeaf(origin);
        return !missing.empty();
    }

    // Returns whether the layer has any voxels.
    bool addLayer() {
        findNear();
        if (addLeaves()) findNear();
        std::vector<std::vector<Added>> added(leaves_.size());
        forLeafRuns(leaves_.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
            const Accessor accessor(tree_);
            for (std::size_t i = begin; i < end; ++i) added[i] = addedTo(i, accessor);
        });
        bool isAnyAdded = false;
        // Voxels that only fill the inside are not counted.
        const double deepest = depth_ > kDepth ? isovalue_ - kDepth * step_ : -INFINITY;
        for (std::size_t i = 0; i < leaves_.size(); ++i) {
            for (const Added& one : added[i]) {
                leaves_[i]->setValueOn(one.place, one.value);
                if (double(one.value) >= deepest) ++beside_;
            }
            isAnyAdded = isAnyAdded || !added[i].empty();
        }
        return isAnyAdded;
    }

    // Returns the voxels to activate in a leaf.
    std::vector<Added> addedTo(std::size_t i, const Accessor& accessor) const {
        const Leaf& leaf = *leaves_[i];
        LeafMask toInside = besides(near_[i].toInside), toOutside = besides(near_[i].toOutside);
        for (std::size_t side = 0; side < kSides.size(); ++side) {
            const Leaf* const other = accessor.probeConstLeaf(besideLeaf(leaf.origin(), side));
            if (!other) continue;
            addFrom(near_[other->transientData()].toInside, side, toInside);
            addFrom(near_[other->transientData()].toOutside, side, toOutside);
        }
        std::vector<Added> added;
        const LeafMask active = maskOf(leaf);
        const Value* values = leaf.buffer().data();
        for (std::size_t x = 0; x < 8; ++x) {
            std::uint64_t rest = (toInside[x] | toOutside[x]) & ~active[x];
            for (; rest != 0; rest &= rest - 1) {
                const int bit = std::countr_zero(rest);
                const auto place = openvdb::Index(64 * x + std::size_t(bit));
                const bool isInside = values[place] < 0;
                if (((isInside ? toInside : toOutside)[x] >> bit & 1) == 0) continue;
                const auto value = valueAt(leaf.offsetToGlobalCoord(place), isInside, accessor);
                if (value) added.push_back({place, *value});
            }
        }
        return added;
    }

    // Returns a value for an inactive voxel that continues its neighbours' values, if needed.
    std::optional<Value> valueAt(const Coord& place, bool isInside,
                                 const Accessor& accessor) const {
        double sum = 0, slopes = 0, mostGrown = 0;
        int count = 0;
        for (const Coord& side : kSides) {
            const Coord from = place + side;
            Value value;
            if (!accessor.probeValue(from, value) || !std::isfinite(double(value))) continue;
            const openvdb::Vec3d gradient = gradientAt(from, double(value), accessor);
            const double grown = -gradient.dot(side.asVec3d());
            sum += double(value) + grown;
            mostGrown = std::max(mostGrown, grown);
            slopes += gradient.length();
            ++count;
        }
        if (count == 0) return {};
        const double slope = slopes > 0 ? slopes / count : step_;
        double value = sum / count;
        // Values end where they would contradict their sign: a volume's own end is no surface.
        // Outside they do not continue along the surface either: away from a surface, values grow
        // by more than half of their slope towards some side of a voxel.
        if (!isInside && (value < 0 || mostGrown < slope / 2)) return {};
        const double least = kLeastShare * step_;
        value = isInside ? std::min(value, -least) : std::max(value, least);
        const double height = (value - isovalue_) / slope;
        if (height < -depth_ || height > kHeight) return {};
        return Value(value);
    }

    // Returns the growth of values from an active voxel along each axis. An axis without active
    // neighbours gets what the other axes leave of the largest step.
    openvdb::Vec3d gradientAt(const Coord& place, double here, const Accessor& accessor) const {
        openvdb::Vec3d gradient(0);
        std::array<int, 3> signs{};
        int unknown = 0;
        for (int axis = 0; axis < 3; ++axis) {
            Coord before = place, behind = place;
            --before[axis];
            ++behind[axis];
            Value low, high;
            const bool hasLow = accessor.probeValue(before, low) && std::isfinite(double(low));
            const bool hasHigh = accessor.probeValue(behind, high) && std::isfinite(double(high));
            if (hasLow && hasHigh) {
                gradient[axis] = (double(high) - double(low)) / 2;
            } else if (hasLow || hasHigh) {
                gradient[axis] = hasLow ? here - double(low) : double(high) - here;
            } else {
                signs[std::size_t(axis)] = int(low < 0) - int(high < 0);
                unknown += signs[std::size_t(axis)] != 0;
            }
        }
        const double rest = step_ * step_ - gradient.lengthSqr();
        if (unknown == 0 || rest <= 0) return gradient;
        for (int axis = 0; axis < 3; ++axis)
            gradient[axis] += signs[std::size_t(axis)] * std::sqrt(rest / unknown);
        return gradient;
    }

    Tree& tree_;
    double voxelSize_;
    double isovalue_;
    double depth_;
    double step_ = 0;
    std::uint64_t beside_ = 0;  // added voxels that any surface needs
    std::vector<Leaf*> leaves_;
    std::vector<Near> near_;  // of each leaf
};

}  // namespace

std::uint64_t completeBand(TreeGrid& grid, const LevelSetSurface& surface) {
    double voxelSize = 0;
    for (int axis = 0; axis < 3 && grid.map->isLinear(); ++axis)
        voxelSize = std::max(voxelSize, grid.map->voxelSize()[axis]);
    std::uint64_t added = 0;
    grid.apply<TreeTypes<openvdb::FloatTree, openvdb::DoubleTree>>([&](auto& tree) {
        BandCompleter<std::decay_t<decltype(tree)>> completer(tree, surface, voxelSize);
        added = completer.addLayers();
        if (surface.isSolid) completer.fillInside();
    });
    return added;
}

}  // namespace deltasplat
