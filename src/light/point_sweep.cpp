// SPDX-License-Identifier: Apache-2.0
// Based on: C. Zhang, R. Crawfis, Volumetric Shadows Using Splatting, 2002 (a buffer of light that
// is carried from slice to slice), for a light among the slices, and P. Joseph, An Improved
// Algorithm for Reprojecting Rays Through Pixel Images, 1982 (a way read once a slice, between
// voxels).
#include "light/point_sweep.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "ingest/codes/leaf_slices.h"
#include "light/point_kernels.h"
#include "memory.h"

namespace deltasplat {
namespace {

// Up to there the slice that the light is in reaches, or the voxel that it is in.
constexpr double kHalf = 0.5;

// Nodes for a slope of 1 that a slice needs: at least as many as there are voxels.
double nodesAt(double distance) {
    double nodes = kLeastNodes;
    while (nodes < distance) nodes *= 2;
    return nodes;
}

// How far aside a voxel lies for a slice that light goes on. Who is where the light is lies ahead.
double slopeOf(double aside, double distance) {
    return distance > kHalf ? aside / distance : 0;
}

// Of nodes that lie on eight voxels from `first` on, those within [least, most].
// @param first     how far aside the first voxel is from the light
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
        // From the voxel before the block on.
        const double place = std::clamp(double(node) * perNode - first + 1, 0.0, 9.0);
        const double before = std::min(std::floor(place), 8.0);
        on.before[on.count] = std::uint32_t(before);
        on.share[on.count] = float(place - before);
    }
    return on;
}

// As many floats as a plane may have before what is not read of it is left out.
constexpr double kLargePlane = 1 << 22;

// Rows and columns of nodes, both ends inclusive.
struct NodeBox {
    glm::i64vec2 least;
    glm::i64vec2 most;

    bool empty() const { return most.x < least.x || most.y < least.y; }
    double count() const {
        return (double(most.x) - double(least.x) + 1) * (double(most.y) - double(least.y) + 1);
    }
    void add(const NodeBox& other) {
        least = glm::min(least, other.least);
        most = glm::max(most, other.most);
    }
};

// What a block reads from or adds to.
struct NodeReach {
    std::size_t group;
    std::size_t place;
    NodeBox nodes;
};

// Nodes that voxels of a block and those beside them lie between, and one more.
// @param aside  of its first voxel
// @param from   distance of its first slice, of which the light may be in the next
NodeBox nodesOfBlock(const glm::dvec2& aside, double from, double nodes, const NodeBox& all) {
    NodeBox box = all;
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

// Cuts what is reached at gaps, as long as there are any.
std::vector<std::vector<NodeReach>> partsOf(std::vector<NodeReach> reaches) {
    std::vector<std::vector<NodeReach>> parts;
    std::vector<std::vector<NodeReach>> left;
    if (!reaches.empty()) left.push_back(std::move(reaches));
    while (!left.empty()) {
        std::vector<NodeReach> some = std::move(left.back());
        left.pop_back();
        std::vector<NodeReach> beyond;
        for (int axis = 0; axis < 2 && beyond.empty(); ++axis) {
            std::vector<std::pair<std::int64_t, std::int64_t>> ends;
            for (const NodeReach& one : some)
                ends.emplace_back(one.nodes.least[axis], one.nodes.most[axis]);
            std::sort(ends.begin(), ends.end());
            std::int64_t widest = 0;
            std::int64_t end = 0;
            std::int64_t last = ends.front().second;
            for (const auto& [first, lastOfOne] : ends) {
                if (first - last - 1 > widest) {
                    widest = first - last - 1;
                    end = last;
                }
                last = std::max(last, lastOfOne);
            }
            if (widest == 0) continue;
            const auto middle = std::stable_partition(
                some.begin(), some.end(),
                [&](const NodeReach& one) { return one.nodes.most[axis] <= end; });
            beyond.assign(middle, some.end());
            some.erase(middle, some.end());
        }
        if (beyond.empty()) {
            parts.push_back(std::move(some));
        } else {
            left.push_back(std::move(some));
            left.push_back(std::move(beyond));
        }
    }
    return parts;
}

}  // namespace

// Rows and columns from the light's own on, at the slice in hand.
struct PointSweep::Strip {
    double nodes;
    std::int64_t firstRow;
    std::int64_t lastRow;
    std::int64_t firstColumn;
    std::int64_t lastColumn;
    std::uint16_t* depths;
    std::vector<float> plane;  // [lastRow - firstRow + 1][columns()]

    std::size_t columns() const { return std::size_t(lastColumn - firstColumn + 1); }
    void doubleNodes();
    Strip partOf(const NodeBox& box) const;
};

// What is between two nodes is mixed of them, as it was.
void PointSweep::Strip::doubleNodes() {
    const std::size_t oldColumns = columns();
    const auto oldRows = std::size_t(lastRow - firstRow + 1);
    const std::vector<float> old = std::move(plane);
    nodes *= 2;
    for (std::int64_t* edge : {&firstRow, &lastRow, &firstColumn, &lastColumn}) *edge *= 2;
    const double count = double(2 * oldRows - 1) * double(columns());
    if (count > kLargePlane) requireMemory("a plane that light is swept through", 4 * count);
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

PointSweep::Strip PointSweep::Strip::partOf(const NodeBox& box) const {
    Strip part{nodes, box.least.x, box.most.x, box.least.y, box.most.y, depths, {}};
    part.plane.reserve(std::size_t(box.count()));
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

// Along the way of the light, from it to the middle of a slice.
double PointSweep::distanceOf(int slice) const {
    return forward_ ? slice - light_.place.x : light_.place.x - slice;
}

// Which blocks light meets, or is to be known in.
void PointSweep::findGroups() {
    for (std::size_t n = 0; n < blocks_.groups.size(); ++n) {
        const auto& group = blocks_.groups[forward_ ? n : blocks_.groups.size() - 1 - n];
        const double farthest = distanceOf(group.firstSlice + (forward_ ? 7 : 0));
        if (farthest <= -kHalf) continue;
        // Voxels are seen from one beside them.
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

// Which part of the plane any voxel reads from.
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
    const auto& group = ahead_.groups.back();
    const double times = nodesAt(distanceOf(group.firstSlice + (forward_ ? 7 : 0))) / nodes_;
    const double nodes =
        (double(last - first) * times + 1) * (double(lastColumn_ - firstColumn_) * times + 1);
    // Twice while nodes are doubled, those before being a quarter. Larger ones are asked for when
    // they come, for most of it is left out.
    return 1.25 * double(sizeof(float)) * std::min(nodes, kLargePlane);
}

void PointSweep::run(std::int64_t first, std::int64_t last, std::uint16_t* depths) const {
    Strip strip{nodes_, firstRow_ + first, firstRow_ + last, firstColumn_, lastColumn_, depths, {}};
    strip.plane.resize(std::size_t(last - first + 1) * strip.columns());
    sweepBlocks(ahead_, strip);
}

void PointSweep::sweepBlocks(const Blocks& blocks, Strip& strip) const {
    for (std::size_t n = 0; n < blocks.groups.size(); ++n) {
        const auto& group = blocks.groups[n];
        const double distance = distanceOf(group.firstSlice + (forward_ ? 0 : 7));
        while (strip.nodes < distance) {
            if (4 * double(strip.plane.size()) > kLargePlane && sweepApart(blocks, n, strip))
                return;
            strip.doubleNodes();
        }
        for (int i = 0; i < 8; ++i)
            sweepSlice(blocks, group, group.firstSlice + (forward_ ? i : 7 - i), strip);
    }
}

// Sweeps blocks from a group on by parts of the plane, where these are smaller than it is.
bool PointSweep::sweepApart(const Blocks& blocks, std::size_t group, Strip& strip) const {
    struct Part {
        NodeBox nodes;
        Blocks blocks;
    };
    const NodeBox whole{{strip.firstRow, strip.firstColumn}, {strip.lastRow, strip.lastColumn}};
    std::vector<NodeReach> reaches;
    for (std::size_t n = group; n < blocks.groups.size(); ++n) {
        const auto& one = blocks.groups[n];
        const double from = distanceOf(one.firstSlice + (forward_ ? 0 : 7)) - kHalf;
        for (std::size_t i = one.begin; i < one.end; ++i) {
            const glm::dvec2 aside =
                glm::dvec2(blocks.places[i].first) - glm::dvec2(light_.place.y, light_.place.z);
            const NodeBox nodes = nodesOfBlock(aside, from, strip.nodes, whole);
            if (!nodes.empty()) reaches.push_back({n, i, nodes});
        }
    }
    const std::vector<std::vector<NodeReach>> parts = partsOf(std::move(reaches));
    const auto boxOf = [](const std::vector<NodeReach>& part) {
        NodeBox box = part.front().nodes;
        for (const NodeReach& one : part) box.add(one.nodes);
        return box;
    };
    double nodes = 0;
    for (const auto& part : parts) nodes += boxOf(part).count();
    if (2 * nodes > whole.count()) return false;
    for (const auto& part : parts) {
        const NodeBox box = boxOf(part);
        Blocks some;
        for (const NodeReach& one : part) {
            const int slice = blocks.groups[one.group].firstSlice;
            if (some.groups.empty() || some.groups.back().firstSlice != slice)
                some.groups.push_back({slice, some.places.size(), 0});
            some.places.push_back(blocks.places[one.place]);
            some.groups.back().end = some.places.size();
        }
        Strip ofPart = strip.partOf(box);
        sweepBlocks(some, ofPart);
    }
    return true;
}

// All voxels of the slice are read before any are added.
void PointSweep::sweepSlice(const Blocks& blocks, const LitBlocks::Along::Group& group, int slice,
                            Strip& strip) const {
    const double distance = distanceOf(slice);
    // Of the slice that the light is in, what lies before it.
    const double share = std::min(distance + kHalf, 1.0);
    if (share <= 0) return;
    while (strip.nodes < distance) strip.doubleNodes();
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

// Those of its voxels that lie farthest from the light along this axis. Of axes that are equal the
// first counts.
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
