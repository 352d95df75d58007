// SPDX-License-Identifier: Apache-2.0
// Based on: C. Zhang, R. Crawfis, Volumetric Shadows Using Splatting, 2002 (a buffer of light that
// is carried from slice to slice), with slices of the volume in place of ones that face half-way.
#include "light/light_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numeric>

#include "ingest/codes/leaf_slices.h"
#include "portable_math.h"

namespace deltasplat {
namespace {

using Row = std::array<float, 8>;

// Beyond it, nothing of the light is left.
constexpr double kMostDepth = 2000;

int axisOf(const glm::dvec3& way) {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(way[i]) > std::abs(way[axis])) axis = i;
    return axis;
}

// -log of the mean of exp(-t) over 0 <= t <= depth.
double meanDepth(double depth) {
    if (depth < 1e-3) return depth / 2 - depth * depth / 24;
    return -portable::log(-portable::expm1(-depth) / depth);
}

std::uint16_t depthCode(float depth) {
    return std::uint16_t(std::min(std::sqrt(depth) * kDepthSteps + 0.5f, 65535.0f));
}

}  // namespace

// Rows [first, last] of the plane, one more than are the strip's own: voxels read between two.
struct LightSweep::Strip {
    int first;
    int last;
    int pitch;
    std::vector<float> plane;  // [last - first + 1][pitch]
    std::vector<Row> ownRows;  // of a slice in hand: what each of its rows adds

    float* at(int row, int column) {
        return &plane[std::size_t(row - first) * std::size_t(pitch) + std::size_t(column)];
    }
};

LightSweep::LightSweep(const LitBlocks& blocks, const ClassTable& classes,
                       const glm::dmat4& worldFromIndex, const glm::dvec3& way)
    : blocks_(blocks) {
    const glm::dvec3 indexWay = glm::inverse(glm::dmat3(worldFromIndex)) * glm::normalize(way);
    axis_ = axisOf(indexWay);
    const glm::ivec3 order = sliceOrder(axis_);
    const double slices = indexWay[axis_];  // in a world unit
    forward_ = slices > 0;
    shift_ = glm::dvec2(indexWay[order[1]], indexWay[order[2]]) / slices;
    const double unitDistances =
        classes.extinctionScale / (std::abs(slices) * classes.unitDistanceWorld);
    for (const Look& look : classes.looks) {
        // Nothing times infinity is nothing.
        const double depth = unitDistances > 0 && look.extinction > 0
                                 ? std::min(look.extinction * unitDistances, kMostDepth)
                                 : 0;
        met_.push_back({float(depth), float(meanDepth(depth))});
    }
    if (blocks.all().empty()) return;
    sortBlocks();
    findRows();
}

void LightSweep::sortBlocks() {
    const std::vector<LitBlocks::Block>& all = blocks_.all();
    order_.resize(all.size());
    std::iota(order_.begin(), order_.end(), 0u);
    const auto placeOf = [&](std::uint32_t number) {
        const glm::ivec3 place = toSliceOrder(all[number].position, axis_);
        return std::array{forward_ ? place.x : -place.x, place.y, place.z};
    };
    std::sort(order_.begin(), order_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return placeOf(a) < placeOf(b); });
    for (std::size_t i = 0; i < order_.size(); ++i) {
        const int first = 8 * all[order_[i]].position[axis_];
        if (groups_.empty() || groups_.back().firstSlice != first) groups_.push_back({first, i, i});
        groups_.back().end = i + 1;
    }
    origin_ = groups_.front().firstSlice;
}

// Which part of the plane any voxel reads from or adds to.
void LightSweep::findRows() {
    glm::ivec2 low(std::numeric_limits<int>::max());
    glm::ivec2 high(std::numeric_limits<int>::min());
    for (const LitBlocks::Block& block : blocks_.all()) {
        const glm::ivec3 place = 8 * toSliceOrder(block.position, axis_);
        low = glm::min(low, glm::ivec2(place.y, place.z));
        high = glm::max(high, glm::ivec2(place.y, place.z) + 7);
    }
    const auto [first, last] = std::minmax(groups_.front().firstSlice, groups_.back().firstSlice);
    const glm::dvec2 ends[] = {placeOf(first), placeOf(last + 7)};
    const glm::ivec2 least = low + glm::ivec2(glm::floor(glm::min(ends[0], ends[1])));
    const glm::ivec2 most = high + glm::ivec2(glm::floor(glm::max(ends[0], ends[1])));
    firstRow_ = least.x;
    lastRow_ = most.x + 1;
    firstColumn_ = least.y;
    columns_ = most.y - least.y + 2;
}

void LightSweep::run(int first, int last, std::span<std::uint16_t> depths) const {
    Strip strip{firstRow_ + first, firstRow_ + last, columns_, {}, {}};
    strip.plane.resize(std::size_t(last - first + 1) * std::size_t(columns_));
    for (const Group& group : groups_) {
        for (int i = 0; i < 8; ++i)
            sweepSlice(group, group.firstSlice + (forward_ ? i : 7 - i), strip, depths);
    }
}

void LightSweep::sweepSlice(const Group& group, int slice, Strip& strip,
                            std::span<std::uint16_t> depths) const {
    const glm::dvec2 place = placeOf(slice);
    const glm::dvec2 whole = glm::floor(place);
    const glm::ivec2 base(whole);
    const glm::vec2 share(place - whole);
    const glm::ivec3 stride = toSliceOrder(kLeafStride, axis_);
    // Calls use(number, block, row, column, n) for the rows of voxels that the strip has to do
    // with: `n` is the place of the first voxel in a leaf.
    const auto forRows = [&](const auto& use) {
        for (std::size_t i = group.begin; i < group.end; ++i) {
            const LitBlocks::Block& block = blocks_.all()[order_[i]];
            const glm::ivec3 first = 8 * toSliceOrder(block.position, axis_);
            const int row = first.y + base.x;
            const int begin = std::max(0, strip.first - 1 - row);
            const int end = std::min(8, strip.last + 1 - row);
            for (int u = begin; u < end; ++u) {
                use(order_[i], block, row + u, first.z + base.y - firstColumn_,
                    (slice - first.x) * stride.x + u * stride.y);
            }
        }
    };
    strip.ownRows.clear();
    forRows([&](std::uint32_t number, const LitBlocks::Block& block, int row, int column, int n) {
        Row own, mean;
        for (int v = 0; v < 8; ++v) {
            const Met& met = met_[std::size_t(blocks_.classOf(block, n + v * stride.z))];
            own[std::size_t(v)] = met.depth;
            mean[std::size_t(v)] = met.mean;
        }
        strip.ownRows.push_back(own);
        if (row < strip.first || row >= strip.last) return;
        const float* above = strip.at(row, column);
        const float* below = strip.at(row + 1, column);
        std::uint16_t* out = &depths[512 * std::size_t(number) + std::size_t(n)];
        for (int v = 0; v < 8; ++v) {
            const float inAbove = above[v] + share.y * (above[v + 1] - above[v]);
            const float inBelow = below[v] + share.y * (below[v + 1] - below[v]);
            const float before = inAbove + share.x * (inBelow - inAbove);
            out[v * stride.z] = depthCode(before + mean[std::size_t(v)]);
        }
    });
    auto own = strip.ownRows.begin();
    forRows([&](std::uint32_t, const LitBlocks::Block&, int row, int column, int) {
        const Row& adds = *own++;
        if (std::all_of(adds.begin(), adds.end(), [](float depth) { return depth == 0; })) return;
        std::array<float, 9> sums;
        sums[0] = (1 - share.y) * adds[0];
        for (std::size_t v = 1; v < 8; ++v)
            sums[v] = (1 - share.y) * adds[v] + share.y * adds[v - 1];
        sums[8] = share.y * adds[7];
        const auto addTo = [&](int target, float weight) {
            if (target < strip.first || target > strip.last) return;
            float* out = strip.at(target, column);
            for (std::size_t v = 0; v < 9; ++v) out[v] += weight * sums[v];
        };
        addTo(row, 1 - share.x);
        addTo(row + 1, share.x);
    });
}

}  // namespace deltasplat
