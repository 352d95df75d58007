// SPDX-License-Identifier: Apache-2.0
#include "volume/cut_volume.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/affine.h"
#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/cut/cut_volume.h"
#include "deltasplat/error.h"
#include "volume/code_counts.h"
#include "volume/cut_region.h"
#include "volume/grid_values.h"
#include "volume/keep_voxels.h"
#include "volume/placement.h"
#include "volume/tree_grid.h"
#include "volume/volume_checks.h"

namespace deltasplat {

namespace {

// Gives voxels that are inactive in the codes the background's value. Tiles' values are never read.
template <typename Tree>
void dropVoxels(Tree& tree, const CodeTree::Tree& kept) {
    const openvdb::MaskTree before(tree, false, true, openvdb::TopologyCopy());
    tree.topologyIntersection(kept);
    std::vector<typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    forLeafRuns(leaves.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (auto off = leaves[i]->beginValueOff(); off; ++off) {
                if (before.isValueOn(off.getCoord()))
                    leaves[i]->setValueOff(off.pos(), tree.background());
            }
        }
    });
}

}  // namespace

void cutSource(VolumeData& volume) {
    SourceGrid cut{volume.source->grid, volume.source->fileMetadata};
    requireMemory("cut", double(cut.grid.tree->memUsage()));
    cut.grid.tree = cut.grid.tree->copy();
    cut.grid.apply<ScalarTrees>([&](auto& tree) {
        dropVoxels(tree, volume.codes->tree());
        if (!volume.codeBook.isExact()) {
            const GridScan scan = scanLeaves(TreeLeaves(tree), kNumbersAlone);
            volume.valueMin = scan.census.min;
            volume.valueMax = scan.census.max;
        }
    });
    volume.source = std::make_shared<const SourceGrid>(std::move(cut));
}

namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& got,
                         const std::string& expected, ErrorCode code = ErrorCode::kUsage) {
    throw Error(code, gotExpected(where, got, expected));
}

template <typename Number>
std::string rangeText(Number low, Number high) {
    using Limits = std::numeric_limits<Number>;
    const Number most = Limits::has_infinity ? Limits::infinity() : Limits::max();
    const Number least = Limits::has_infinity ? -Limits::infinity() : Limits::min();
    return (low == least ? "" : numberText(double(low))) + ":" +
           (high == most ? "" : numberText(double(high)));
}

// "0:255,0:255,:127": an open end has no number.
template <typename Box>
std::string boxText(const Box& box) {
    return rangeText(box.min.x, box.max.x) + "," + rangeText(box.min.y, box.max.y) + "," +
           rangeText(box.min.z, box.max.z);
}

void requireNormal(const ClipPlane& plane) {
    const double sum = plane.normalWorld.x + plane.normalWorld.y + plane.normalWorld.z +
                       plane.pointWorld.x + plane.pointWorld.y + plane.pointWorld.z;
    if (std::isfinite(sum) && plane.normalWorld != glm::dvec3(0)) return;
    refuse("`clipPlanes`",
           "point " + numberText(plane.pointWorld) + " and normal " + numberText(plane.normalWorld),
           "finite numbers, and a normal other than 0,0,0");
}

void requireWorldBox(const WorldBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!(box.min[axis] <= box.max[axis]))
            refuse("`cropWorld`", boxText(box), "a box whose ends are not before its beginnings");
    }
}

void checkCut(const Cut& cut) {
    for (const ClipPlane& plane : cut.clipPlanes) requireNormal(plane);
    if (cut.cropWorld) requireWorldBox(*cut.cropWorld);
}

// Returns the part of a box that crops by index leave.
IndexBox croppedBox(const Cut& cut, const IndexBox& box) {
    IndexBox left = box;
    if (cut.cropIndex) {
        left = sharedBox(left, *cut.cropIndex);
        if (left.empty()) {
            refuse("`cropIndex`", boxText(*cut.cropIndex),
                   "a box that overlaps the volume's, " + boxText(box));
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        const std::optional<glm::ivec2>& slices = cut.slices[std::size_t(axis)];
        if (!slices) continue;
        const std::string name{"xyz"[axis], ':'};
        const std::string had = name + rangeText(left.min[axis], left.max[axis]);
        left.min[axis] = std::max(left.min[axis], slices->x);
        left.max[axis] = std::min(left.max[axis], slices->y);
        if (left.min[axis] <= left.max[axis]) continue;
        refuse("`slices`", name + rangeText(slices->x, slices->y),
               "slices of those that there are, " + had);
    }
    return left;
}

// The sides of a world box as planes. An infinite end has no side.
std::vector<IndexPlane> sidesOf(const WorldBox& box, const glm::dmat4& worldFromIndex) {
    std::vector<IndexPlane> sides;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool isFirst : {true, false}) {
            ClipPlane side{glm::dvec3(0), glm::dvec3(0)};
            side.pointWorld[axis] = isFirst ? box.min[axis] : box.max[axis];
            side.normalWorld[axis] = isFirst ? 1 : -1;
            if (std::isfinite(side.pointWorld[axis]))
                sides.push_back(indexPlane(side, worldFromIndex));
        }
    }
    return sides;
}

bool keep(const CutRegion& region, VolumeData& volume) {
    volume.codes = keepVoxels(*volume.codes, region);
    return !volume.codes->tree().empty();
}

void crop(const Cut& cut, VolumeData& volume) {
    const IndexBox all = volume.box;
    CutRegion region;
    region.box = volume.box = croppedBox(cut, all);
    if (cut.cropWorld) region.planes = sidesOf(*cut.cropWorld, volume.worldFromIndex);
    if (!keep(region, volume)) {
        const std::string expected = "a box with active voxels of those in ";
        if (cut.cropWorld) {
            refuse("`cropWorld`", "the world box " + boxText(*cut.cropWorld),
                   expected + boxText(worldBox(all, volume.worldFromIndex)));
        }
        refuse(cut.cropIndex ? "`cropIndex`" : "`slices`", boxText(region.box),
               expected + boxText(all));
    }
    if (cut.cropWorld || volume.hasBackground) volume.box = activeBox(volume.codes->tree());
}

void clip(const Cut& cut, VolumeData& volume) {
    CutRegion region;
    for (const ClipPlane& plane : cut.clipPlanes)
        region.planes.push_back(indexPlane(plane, volume.worldFromIndex));
    if (keep(region, volume)) return;
    refuse("`clipPlanes`", "planes that leave nothing",
           "some voxel beyond all of them, of those in the world box " +
               boxText(worldBox(volume.box, volume.worldFromIndex)));
}

// Returns the mask in the volume's unit of length, if both units are known.
Volume inUnitOf(const VolumeData& volume, const Volume& mask) {
    const double own = millimetresIn(mask.lengthUnit()), wanted = millimetresIn(volume.lengthUnit);
    if (!(own > 0 && wanted > 0 && own != wanted)) return mask;
    glm::dmat4 scaled = mask.worldFromIndex();
    scaleLengths(scaled, own / wanted);
    return mask.withPlace(scaled, mask.space(), volume.lengthUnit);
}

void applyMask(const Volume& given, const Listener& listener, VolumeData& volume) {
    const Volume mask = inUnitOf(volume, given);
    const MaskVoxels voxels(mask, volume);
    if (voxels.resamples()) {
        listener.warn(
            "`mask`: its voxels lie elsewhere than the volume's; each of these takes "
            "the nearest of those");
    }
    CutRegion region;
    region.mask = &voxels;
    if (keep(region, volume)) return;
    refuse("`mask`",
           "a mask in the world box " + boxText(worldBox(mask.box(), mask.worldFromIndex())) +
               " that leaves nothing",
           "one that keeps some voxel of those in " +
               boxText(worldBox(volume.box, volume.worldFromIndex)),
           ErrorCode::kInput);
}

void count(const Volume& whole, VolumeData& left) {
    left.histogram = histogramOf(left.codes->tree());
    summarize(left);
    if (!left.codeBook.isExact()) {
        // The values of codes may exceed the range of the source's values.
        left.valueMin = std::clamp(left.valueMin, whole.valueMin(), whole.valueMax());
        left.valueMax = std::clamp(left.valueMax, whole.valueMin(), whole.valueMax());
    }
    if (left.source) cutSource(left);
}

}  // namespace

Volume cutVolume(const Volume& volume, const Cut& cut, const Listener& listener) {
    checkCut(cut);
    if (cut.empty() || volume.empty()) return volume;
    VolumeData left = volume.data();
    if (!left.uncut) left.uncut = left.codes;
    if (cut.crops()) crop(cut, left);
    if (!cut.clipPlanes.empty()) clip(cut, left);
    if (cut.mask) applyMask(*cut.mask, listener, left);
    count(volume, left);
    return Volume(std::move(left));
}

}  // namespace deltasplat
