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
#include <limits>
#include <numeric>

#include "ingest/codes/leaf_slices.h"
#include "light/sweep_kernels.h"
#include "portable_math.h"

namespace deltasplat {
namespace {

// What a slice of a block adds to the plane.
struct MetBlock {
    SweptPlace place;
    int end;  // of rows of the plane
    std::array<float, 64> own;
};

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

}  // namespace

// Rows [first, last] of the plane, one more than are the strip's own: voxels read between two.
struct LightSweep::Strip {
    std::int64_t first;
    std::int64_t last;
    const std::uint16_t* classes;
    std::uint16_t* depths;
    std::vector<float> plane;     // [last - first + 1][columns]
    std::vector<MetBlock> toAdd;  // of the slice in hand
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
        metDepths_.push_back(float(depth));
        metMeans_.push_back(float(meanDepth(depth)));
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
    glm::i64vec2 low(std::numeric_limits<int>::max());
    glm::i64vec2 high(std::numeric_limits<int>::min());
    for (const LitBlocks::Block& block : blocks_.all()) {
        const glm::ivec3 place = toSliceOrder(block.position, axis_);
        const glm::i64vec2 first(8 * std::int64_t{place.y}, 8 * std::int64_t{place.z});
        low = glm::min(low, first);
        high = glm::max(high, first + std::int64_t{7});
    }
    const auto [first, last] = std::minmax(groups_.front().firstSlice, groups_.back().firstSlice);
    const glm::dvec2 ends[] = {placeOf(first), placeOf(last + 7)};
    const glm::i64vec2 least = low + glm::i64vec2(glm::floor(glm::min(ends[0], ends[1])));
    const glm::i64vec2 most = high + glm::i64vec2(glm::floor(glm::max(ends[0], ends[1])));
    firstRow_ = least.x;
    lastRow_ = most.x + 1;
    firstColumn_ = least.y;
    columns_ = most.y - least.y + 2;
}

void LightSweep::run(std::int64_t first, std::int64_t last, const std::uint16_t* classes,
                     std::uint16_t* depths) const {
    Strip strip{firstRow_ + first, firstRow_ + last, classes, depths, {}, {}};
    strip.plane.resize(std::size_t(last - first + 1) * std::size_t(columns_));
    for (const Group& group : groups_) {
        for (int i = 0; i < 8; ++i)
            sweepSlice(group, group.firstSlice + (forward_ ? i : 7 - i), strip);
    }
}

// All voxels of the slice read before any adds.
void LightSweep::sweepSlice(const Group& group, int slice, Strip& strip) const {
    const glm::dvec2 place = placeOf(slice);
    const glm::dvec2 whole = glm::floor(place);
    const glm::i64vec2 base(whole);
    const glm::vec2 share(place - whole);
    const glm::ivec3 stride = toSliceOrder(kLeafStride, axis_);
    const MetClasses met{metDepths_.data(), metMeans_.data()};
    std::array<float, 64> means;
    std::array<std::uint16_t, 64> codes;
    strip.toAdd.clear();
    for (std::size_t i = group.begin; i < group.end; ++i) {
        const std::size_t number = order_[i];
        const glm::ivec3 first = 8 * toSliceOrder(blocks_.all()[number].position, axis_);
        // Of the strip, counted from the block's first row.
        const std::int64_t firstOfStrip = strip.first - (first.y + base.x);
        const std::int64_t lastOfStrip = strip.last - (first.y + base.x);
        if (lastOfStrip < 0 || firstOfStrip > 8) continue;
        const int begin = int(std::max<std::int64_t>(0, firstOfStrip));
        const int end = int(std::min<std::int64_t>(8, lastOfStrip));
        const std::int64_t column = first.z + base.y - firstColumn_;
        const SweptPlace swept{
            &strip.plane[std::size_t((begin - firstOfStrip) * columns_ + column)],
            std::size_t(columns_), begin, share};
        const std::size_t inBlock = 64 * std::size_t(slice - first.x);
        MetBlock block{swept, int(std::min<std::int64_t>(9, lastOfStrip + 1)), {}};
        const bool isAny =
            lookUpMet(met, strip.classes + 512 * number + inBlock, block.own.data(), means.data());
        if (begin < end) {
            readSwept(swept, end, means.data(), codes.data());
            std::uint16_t* out = strip.depths + 512 * number + (slice - first.x) * stride.x;
            for (int u = begin; u < end; ++u) {
                for (int v = 0; v < 8; ++v)
                    out[u * stride.y + v * stride.z] = codes[std::size_t(8 * u + v)];
            }
        }
        if (isAny) strip.toAdd.push_back(block);
    }
    for (const MetBlock& block : strip.toAdd) addSwept(block.place, block.end, block.own.data());
}

}  // namespace deltasplat
