// SPDX-License-Identifier: Apache-2.0
// Based on: C. Zhang, R. Crawfis, Volumetric Shadows Using Splatting, 2002 (a light buffer carried
// from slice to slice), for a light among the slices, and P. Joseph, An Improved Algorithm for
// Reprojecting Rays Through Pixel Images, 1982 (a ray read once per slice, between voxels).
#include "lighting/point_sweep.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "lighting/light_depths.h"
#include "lighting/point_kernels.h"
#include "volume/leaf_slices.h"

namespace deltasplat {
namespace {

// Half the thickness of the light's own slice or voxel.
constexpr double kHalf = 0.5;

// Nodes for a slope of 1 at a slice: at least as many as voxels.
double nodesAt(double distance) {
    double nodes = kLeastNodes;
    while (nodes < distance) nodes *= 2;
    return nodes;
}

// Sideways voxels per slice of the light's way. A voxel at the light counts as straight ahead.
double slopeOf(double aside, double distance) {
    return distance > kHalf ? aside / distance : 0;
}

// Returns the nodes within [least, most] on eight voxels.
// @param first     sideways distance of the first voxel from the light
// @param distance  of the slice
NodesOnBlock nodesOn(double first, double distance, double nodes, std::int64_t least,
                     std::int64_t most) {
    const double perNode = distance / nodes;  // voxels
    const double lowest = std::floor((first - 1) / perNode);
    const double highest = std::ceil((first + 8) / perNode);
    NodesOnBlock on;
    on.first = std::int64_t(std::clamp(lowest, double(least), double(most) + 1));
    const auto last = std::int64_t(std::clamp(highest, double(least) - 1, double(most)));
    for (std::int64_t node = on.first; node <= last; ++node, ++on.count) {
        // Counted from the voxel before the block.
        const double place = std::clamp(double(node) * perNode - first + 1, 0.0, 9.0);
        const double before = std::min(std::floor(place), 8.0);
        on.before[on.count] = std::uint32_t(before);
        on.share[on.count] = float(place - before);
    }
    return on;
}

// Larger planes, in floats, are swept in parts.
constexpr double kLargePlane = 1 << 22;

// Nodes that a block reads or writes.
struct NodeReach : PlaneBox {
    std::size_t group;
    std::size_t place;
};

// Nodes between which a block's voxels and their neighbours lie, and one more.
// @param aside  sideways distance of the first voxel
// @param from   distance of the first slice; the light may be in the next one
PlaneBox nodesOfBlock(const glm::dvec2& aside, double from, double nodes, const PlaneBox& all) {
    PlaneBox box = all;
    const double nearest = std::max(from, kHalf);
    const double farthest = nearest + 8;
    for (int axis = 0; axis < 2; ++axis) {
        const double low = aside[axis] - 1;
        const double high = aside[axis] + 8;
        const double least = low / (low < 0 ? nearest : farthest) * nodes;
        const double most = high / (high < 0 ? farthest : nearest) * nodes;
        const auto bounded = [&](double node) {
            return std::int64_t(
                std::clamp(node, double(all.least[axis]) - 1, double(all.most[axis]) + 1));
        };
        box.least[axis] = std::max(all.least[axis], bounded(std::floor(least) - 1));
        box.most[axis] = std::min(all.most[axis], bounded(std::ceil(most) + 1));
    }
    return box;
}

}  // namespace

// Rows and columns relative to the light, at the current slice.
struct PointSweep::Strip {
    double nodes;
    std::int64_t firstRow;
    std::int64_t lastRow;
    std::int64_t firstColumn;
    std::int64_t lastColumn;
    std::uint16_t* depths;     // null: only the plane's size is computed
    std::vector<float> plane;  // [lastRow - firstRow + 1][columns()]; empty without depths

    std::size_t columns() const { return std::size_t(lastColumn - firstColumn + 1); }
    PlaneBox box() const { return {{firstRow, firstColumn}, {lastRow, lastColumn}}; }
    void doubleNodes();
    Strip partOf(const PlaneBox& box) const;
};

// New nodes are means of their neighbours, as interpolation between them was before.
void PointSweep::Strip::doubleNodes() {
    nodes *= 2;
    const std::size_t oldColumns = columns();
    const auto oldRows = std::size_t(lastRow - firstRow + 1);
    const std::vector<float> old = std::move(plane);
    for (std::int64_t* edge : {&firstRow, &lastRow, &firstColumn, &lastColumn}) *edge *= 2;
    if (!depths) return;
    plane.resize((2 * oldRows - 1) * columns());
    for (std::size_t row = 0; row < oldRows; ++row) {
        const float* in = &old[row * oldColumns];
        float* out = &plane[2 * row * columns()];
        for (std::size_t n = 0; n + 1 < oldColumns; ++n) {
            out[2 * n] = in[n];
            out[2 * n + 1] = 0.5f * (in[n] + in[n + 1]);
        }
        out[2 * oldColumns - 2] = in[oldColumns - 1];
        if (row == 0) continue;
        const float* before = out - 2 * columns();
        float* between = out - columns();
        for (std::size_t n = 0; n < columns(); ++n) between[n] = 0.5f * (before[n] + out[n]);
    }
}

// Without a plane, the extinction so far is 0.
PointSweep::Strip PointSweep::Strip::partOf(const PlaneBox& box) const {
    Strip part{nodes, box.least.x, box.most.x, box.least.y, box.most.y, depths, {}};
    if (!depths) return part;
    part.plane.reserve(std::size_t(box.count()));
    if (plane.empty()) {
        part.plane.resize(std::size_t(box.count()));
        return part;
    }
    for (std::int64_t row = part.firstRow; row <= part.lastRow; ++row) {
        const float* first = &plane[std::size_t(row - firstRow) * columns() +
                                    std::size_t(part.firstColumn - firstColumn)];
        part.plane.insert(part.plane.end(), first, first + part.columns());
    }
    return part;
}

PointSweep::PointSweep(const LitBlocks::Along& blocks, const PointPlace& light, bool forward,
                       const MetClasses& met)
    : blocks_(blocks), light_(light), forward_(forward), met_(met) {
    findGroups();
    if (!ahead_.groups.empty()) findRows();
}

// Along the light's way, from the light to the middle of a slice.
double PointSweep::distanceOf(int slice) const {
    return forward_ ? slice - light_.place.x : light_.place.x - slice;
}

// Finds the blocks that light meets or that need light.
void PointSweep::findGroups() {
    for (std::size_t n = 0; n < blocks_.groups.size(); ++n) {
        const auto& group = blocks_.groups[forward_ ? n : blocks_.groups.size() - 1 - n];
        const double farthest = distanceOf(group.firstSlice + (forward_ ? 7 : 0));
        if (farthest <= -kHalf) continue;
        // Neighbours of voxels count, too.
        const double aside = std::max(farthest, kHalf) + 1;
        const auto isAhead = [&](double first, double light) {
            return first - light <= aside && first + 7 - light >= -aside;
        };
        const std::size_t begin = ahead_.places.size();
        for (std::size_t i = group.begin; i < group.end; ++i) {
            const LitBlocks::Along::Place& block = blocks_.order[i];
            if (isAhead(block.first.x, light_.place.y) && isAhead(block.first.y, light_.place.z))
                ahead_.places.push_back(block);
        }
        if (begin < ahead_.places.size())
            ahead_.groups.push_back({group.firstSlice, begin, ahead_.places.size()});
    }
}

// Finds the part of the plane that voxels read.
void PointSweep::findRows() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    glm::dvec2 least(kInfinity);
    glm::dvec2 most(-kInfinity);
    const auto hold = [&](double aside, double distance, int i) {
        const double slope = std::clamp(slopeOf(aside, distance), -1.0, 1.0);
        least[i] = std::min(least[i], slope);
        most[i] = std::max(most[i], slope);
    };
    nodes_ = kInfinity;
    for (const auto& group : ahead_.groups) {
        for (int slice = group.firstSlice; slice < group.firstSlice + 8; ++slice) {
            const double distance = distanceOf(slice);
            if (distance > -kHalf) nodes_ = std::min(nodes_, nodesAt(distance));
            if (distance < 0) continue;
            for (std::size_t n = group.begin; n < group.end; ++n) {
                for (const double end : {0.0, 7.0}) {
                    hold(ahead_.places[n].first.x + end - light_.place.y, distance, 0);
                    hold(ahead_.places[n].first.y + end - light_.place.z, distance, 1);
                }
            }
        }
    }
    if (!(least.x <= most.x)) return;
    firstRow_ = std::int64_t(std::floor(least.x * nodes_));
    lastRow_ = std::int64_t(std::floor(most.x * nodes_)) + 1;
    firstColumn_ = std::int64_t(std::floor(least.y * nodes_));
    lastColumn_ = std::int64_t(std::floor(most.y * nodes_)) + 1;
}

double PointSweep::bytes(std::int64_t first, std::int64_t last) const {
    return double(sizeof(float)) * sweep(first, last, nullptr);
}

void PointSweep::run(std::int64_t first, std::int64_t last, std::uint16_t* depths) const {
    sweep(first, last, depths);
}

// Returns the largest number of nodes at a time; without depths, sweeps nothing.
double PointSweep::sweep(std::int64_t first, std::int64_t last, std::uint16_t* depths) const {
    const Strip strip{
        nodes_, firstRow_ + first, firstRow_ + last, firstColumn_, lastColumn_, depths, {}};
    if (strip.box().count() > kLargePlane) {
        if (const std::optional<double> most = sweepApart(ahead_, 0, strip)) return *most;
    }
    Strip whole = strip.partOf(strip.box());
    return sweepBlocks(ahead_, whole);
}

double PointSweep::sweepBlocks(const Blocks& blocks, Strip& strip) const {
    double most = strip.box().count();
    const auto doubleNodes = [&] {
        strip.doubleNodes();
        // The old plane is a quarter of the new one.
        most = std::max(most, 1.25 * strip.box().count());
    };
    for (std::size_t n = 0; n < blocks.groups.size(); ++n) {
        const auto& group = blocks.groups[n];
        const auto sliceOf = [&](int i) { return group.firstSlice + (forward_ ? i : 7 - i); };
        while (strip.nodes < distanceOf(sliceOf(7))) {
            const double nodes = strip.box().count();
            if (4 * nodes > kLargePlane) {
                const std::optional<double> ofParts = sweepApart(blocks, n, strip);
                if (ofParts) return std::max(most, nodes + *ofParts);
            }
            if (strip.nodes >= distanceOf(sliceOf(0))) break;
            doubleNodes();
        }
        for (int i = 0; i < 8; ++i) {
            const int slice = sliceOf(i);
            while (strip.nodes < distanceOf(slice)) doubleNodes();
            if (strip.depths) sweepSlice(blocks, group, slice, strip);
        }
    }
    return most;
}

// Sweeps blocks from a group on in separate parts of the plane, if these are small enough; returns
// the largest number of nodes of a part at a time.
std::optional<double> PointSweep::sweepApart(const Blocks& blocks, std::size_t group,
                                             const Strip& strip) const {
    constexpr double kSmallPart = 1 << 10;
    const PlaneBox whole = strip.box();
    std::vector<NodeReach> reaches;
    for (std::size_t n = group; n < blocks.groups.size(); ++n) {
        const auto& one = blocks.groups[n];
        const double from = distanceOf(one.firstSlice + (forward_ ? 0 : 7)) - kHalf;
        for (std::size_t i = one.begin; i < one.end; ++i) {
            const glm::dvec2 aside =
                glm::dvec2(blocks.places[i].first) - glm::dvec2(light_.place.y, light_.place.z);
            const PlaneBox nodes = nodesOfBlock(aside, from, strip.nodes, whole);
            if (!nodes.empty()) reaches.push_back({nodes, n, i});
        }
    }
    const std::vector<std::vector<NodeReach>> parts = partsAtGaps(std::move(reaches), kSmallPart);
    double nodes = 0;
    for (const auto& part : parts) nodes += boxOf(part).count();
    if (2 * nodes > whole.count()) return std::nullopt;
    double most = 0;
    for (const auto& part : parts) {
        Blocks some;
        for (const NodeReach& one : part) {
            const int slice = blocks.groups[one.group].firstSlice;
            if (some.groups.empty() || some.groups.back().firstSlice != slice)
                some.groups.push_back({slice, some.places.size(), 0});
            some.places.push_back(blocks.places[one.place]);
            some.groups.back().end = some.places.size();
        }
        Strip ofPart = strip.partOf(boxOf(part));
        most = std::max(most, sweepBlocks(some, ofPart));
    }
    return most;
}

// All voxels of the slice read before any voxel adds.
void PointSweep::sweepSlice(const Blocks& blocks, const LitBlocks::Along::Group& group, int slice,
                            Strip& strip) const {
    const double distance = distanceOf(slice);
    // In the light's own slice, only the part ahead of the light counts.
    const double share = std::min(distance + kHalf, 1.0);
    if (share <= 0) return;
    const glm::ivec3 stride = toSliceOrder(kLeafStride, blocks_.sliceAxis);
    const auto sliceInBlock = std::size_t(slice - group.firstSlice);
    if (distance >= 0) {
        for (std::size_t n = group.begin; n < group.end; ++n) {
            read(blocks.places[n], distance, strip,
                 strip.depths + 512 * blocks.places[n].number +
                     sliceInBlock * std::size_t(stride.x));
        }
    }
    const double middle = share < 1 ? 0.5 * share : distance;
    std::array<float, 64> own;
    for (std::size_t n = group.begin; n < group.end; ++n) {
        const LitBlocks::Along::Place& block = blocks.places[n];
        const NodesOnBlock rows = nodesOn(block.first.x - light_.place.y, middle, strip.nodes,
                                          strip.firstRow, strip.lastRow);
        if (rows.count == 0) continue;
        const NodesOnBlock columns = nodesOn(block.first.y - light_.place.z, middle, strip.nodes,
                                             strip.firstColumn, strip.lastColumn);
        if (columns.count == 0) continue;
        const std::uint16_t* classes = &(*blocks_.classes)[512 * block.number + 64 * sliceInBlock];
        if (!lookUpMet(met_, classes, own.data())) continue;
        addToNodes(rows, columns, own.data(), float(share),
                   &strip.plane[std::size_t(rows.first - strip.firstRow) * strip.columns() +
                                std::size_t(columns.first - strip.firstColumn)],
                   strip.columns());
    }
}

// Reads the voxels farthest from the light along this axis; of equal axes, the first counts.
void PointSweep::read(const LitBlocks::Along::Place& block, double distance, const Strip& strip,
                      std::uint16_t* out) const {
    const glm::ivec3 order = sliceOrder(blocks_.sliceAxis);
    const auto voxelsOf = [&](double first, int axis, std::int64_t firstNode,
                              std::int64_t lastNode) {
        VoxelsBetweenNodes voxels;
        for (int i = 0; i < 8; ++i) {
            const double aside = first + i - light_.place[axis];
            const double most = std::abs(aside);
            const bool isHere = most < distance || (most == distance && order[0] < order[axis]);
            const double slope = slopeOf(aside, distance);
            const double place = slope * strip.nodes;
            const double before = std::floor(place);
            if (!isHere || before < double(firstNode) || before >= double(lastNode)) continue;
            if (voxels.end == 0) voxels.begin = i;
            voxels.end = i + 1;
            const auto n = std::size_t(i);
            voxels.before[n] = std::ptrdiff_t(before) - firstNode;
            voxels.share[n] = float(place - before);
            voxels.way[n] = glm::vec3(slope * light_.steps[axis]);
        }
        return voxels;
    };
    VoxelsBetweenNodes rows = voxelsOf(block.first.x, 1, strip.firstRow, strip.lastRow);
    if (rows.begin == rows.end) return;
    const VoxelsBetweenNodes columns =
        voxelsOf(block.first.y, 2, strip.firstColumn, strip.lastColumn);
    const glm::vec3 ahead((forward_ ? 1.0 : -1.0) * light_.steps[0]);
    for (int u = rows.begin; u < rows.end; ++u) rows.way[std::size_t(u)] += ahead;
    const glm::ivec3 stride = toSliceOrder(kLeafStride, blocks_.sliceAxis);
    readBetweenNodes(rows, columns, strip.plane.data(), strip.columns(), out, {stride.y, stride.z});
}

}  // namespace deltasplat
