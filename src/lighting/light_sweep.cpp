// SPDX-License-Identifier: Apache-2.0
// Based on: C. Zhang, R. Crawfis, Volumetric Shadows Using Splatting, 2002 (a buffer of light that
// is carried from slice to slice), with slices of the volume in place of ones that face half-way.
#include "lighting/light_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "base/affine.h"
#include "volume/leaf_slices.h"

namespace deltasplat {
namespace {

// What a slice of a block adds to the plane.
struct MetBlock {
    SweptPlace place;
    int end;  // of rows of the plane
    std::array<float, 64> own;
};

}  // namespace

LightWay::LightWay(const glm::dmat4& worldFromIndex, const glm::dvec3& way) {
    const glm::dvec3 indexWay = glm::inverse(glm::dmat3(worldFromIndex)) * unitVectorOf(way);
    sliceAxis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(indexWay[i]) > std::abs(indexWay[sliceAxis])) sliceAxis = i;
    const glm::ivec3 order = sliceOrder(sliceAxis);
    const double slices = indexWay[sliceAxis];  // in a world unit
    forward = slices > 0;
    shift = glm::dvec2(indexWay[order[1]], indexWay[order[2]]) / slices;
    sliceWorld = 1 / std::abs(slices);
}

// Rows [first, last] of the plane, one more than are the strip's own: voxels read between two.
struct LightSweep::Strip {
    std::int64_t first;
    std::int64_t last;
    std::uint16_t* depths;
    std::vector<float> plane;     // [last - first + 1][columns]
    std::vector<MetBlock> toAdd;  // of the slice in hand
};

LightSweep::LightSweep(const LitBlocks::Along& blocks, const LightWay& way, int origin,
                       const MetClasses& met)
    : blocks_(blocks), way_(way), origin_(origin), met_(met) {
    if (!blocks.order.empty()) findRows();
}

// Which part of the plane any voxel reads from or adds to.
void LightSweep::findRows() {
    const PlaneBox all = boxOf(reaches());
    firstRow_ = all.least.x;
    lastRow_ = all.most.x;
    firstColumn_ = all.least.y;
    columns_ = all.most.y - all.least.y + 1;
}

std::vector<PlaneReach> LightSweep::reaches() const {
    std::vector<PlaneReach> all;
    all.reserve(blocks_.order.size());
    for (const LitBlocks::Along::Group& group : blocks_.groups) {
        const glm::i64vec2 ends[] = {glm::i64vec2(glm::floor(placeOf(group.firstSlice))),
                                     glm::i64vec2(glm::floor(placeOf(group.firstSlice + 7)))};
        for (std::size_t i = group.begin; i < group.end; ++i) {
            const glm::i64vec2 first(blocks_.order[i].first);
            all.push_back({{first + glm::min(ends[0], ends[1]),
                            first + glm::max(ends[0], ends[1]) + std::int64_t{8}},
                           group.firstSlice,
                           blocks_.order[i]});
        }
    }
    return all;
}

std::vector<LitBlocks::Along> LightSweep::apart() const {
    constexpr double kSmallPlane = 1 << 20;
    std::vector<LitBlocks::Along> parts;
    for (const std::vector<PlaneReach>& some : partsAtGaps(reaches(), kSmallPlane)) {
        LitBlocks::Along& part = parts.emplace_back();
        part.sliceAxis = blocks_.sliceAxis;
        part.classes = blocks_.classes;
        for (const PlaneReach& one : some) part.add(one.slice, one.place);
    }
    return parts;
}

void LightSweep::run(std::int64_t first, std::int64_t last, std::uint16_t* depths) const {
    Strip strip{firstRow_ + first, firstRow_ + last, depths, {}, {}};
    strip.plane.resize(std::size_t(last - first + 1) * std::size_t(columns_));
    const std::size_t groups = blocks_.groups.size();
    for (std::size_t n = 0; n < groups; ++n) {
        const auto& group = blocks_.groups[way_.forward ? n : groups - 1 - n];
        for (int i = 0; i < 8; ++i)
            sweepSlice(group, group.firstSlice + (way_.forward ? i : 7 - i), strip);
    }
}

// All voxels of the slice read before any adds.
void LightSweep::sweepSlice(const LitBlocks::Along::Group& group, int slice, Strip& strip) const {
    const glm::dvec2 place = placeOf(slice);
    const glm::dvec2 whole = glm::floor(place);
    const glm::i64vec2 base(whole);
    const glm::vec2 share(place - whole);
    const glm::ivec3 stride = toSliceOrder(kLeafStride, blocks_.sliceAxis);
    const auto sliceInBlock = std::size_t(slice - group.firstSlice);
    std::array<std::uint16_t, 64> codes;
    strip.toAdd.clear();
    for (std::size_t i = group.begin; i < group.end; ++i) {
        const LitBlocks::Along::Place& block = blocks_.order[i];
        const std::int64_t firstOfStrip = strip.first - (block.first.x + base.x);
        const std::int64_t lastOfStrip = strip.last - (block.first.x + base.x);
        if (lastOfStrip < 0 || firstOfStrip > 8) continue;
        const int begin = int(std::max<std::int64_t>(0, firstOfStrip));
        const int end = int(std::min<std::int64_t>(8, lastOfStrip));
        const std::int64_t column = block.first.y + base.y - firstColumn_;
        const SweptPlace swept{
            &strip.plane[std::size_t((begin - firstOfStrip) * columns_ + column)],
            std::size_t(columns_), begin, share};
        if (begin < end) {
            readSwept(swept, end, codes.data());
            std::uint16_t* out =
                strip.depths + 512 * block.number + sliceInBlock * std::size_t(stride.x);
            const std::uint16_t* code = codes.data() + std::ptrdiff_t{8} * begin;
            for (int u = begin; u < end; ++u) {
                for (int v = 0; v < 8; ++v) out[u * stride.y + v * stride.z] = *code++;
            }
        }
        MetBlock met{swept, int(std::min<std::int64_t>(9, lastOfStrip + 1)), {}};
        const std::uint16_t* classes = &(*blocks_.classes)[512 * block.number + 64 * sliceInBlock];
        if (lookUpMet(met_, classes, met.own.data())) strip.toAdd.push_back(met);
    }
    for (const MetBlock& met : strip.toAdd) addSwept(met.place, met.end, met.own.data());
}

}  // namespace deltasplat
