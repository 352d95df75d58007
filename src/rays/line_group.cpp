// SPDX-License-Identifier: Apache-2.0
#include "rays/line_group.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <numeric>

namespace deltasplat {

void LineGroup::addSlices(const glm::dvec2& slices) {
    slices_ = {std::min(slices_.x, slices.x), std::max(slices_.y, slices.y)};
}

void LineGroup::addLine(const glm::dvec2& start, const glm::dvec2& slope) {
    const auto add = [&](Range& range, double slice) {
        range.low = glm::min(range.low, start + slice * slope);
        range.high = glm::max(range.high, start + slice * slope);
    };
    add(first_, slices_.x - 1);
    add(last_, slices_.y + 1);
}

// The smallest of linear functions lies above the straight line between its ends, the largest
// below.
LineGroup::Range LineGroup::rangeAt(double slice) const {
    const double way = std::clamp((slice - slices_.x + 1) / (slices_.y - slices_.x + 2), 0.0, 1.0);
    return {glm::mix(first_.low, last_.low, way), glm::mix(first_.high, last_.high, way)};
}

float LineGroup::topOf(const TopGrid& tops, const RayAxes& axes, const BlockLayer& layer) const {
    // Rounding puts no line into a voxel that is not looked at.
    constexpr double kRounding = 1e-6;
    const glm::dvec2 from = rangeAt(layer.slices.x - 1).low - kRounding;
    const glm::dvec2 to = rangeAt(layer.slices.y + 1).high + kRounding + 1.0;
    glm::ivec3 low(0), high(0);
    low[axes.order[0]] = high[axes.order[0]] = layer.block;
    for (int i = 1; i < 3; ++i) {
        const double last = axes.count[i];
        if (to[i - 1] < 0 || from[i - 1] > last) return -std::numeric_limits<float>::infinity();
        const int a = axes.voxelAt(i, int(std::floor(std::max(from[i - 1], 0.0)))) >> 3;
        const int b = axes.voxelAt(i, int(std::floor(std::min(to[i - 1], last)))) >> 3;
        low[axes.order[i]] = std::min(a, b);
        high[axes.order[i]] = std::max(a, b);
    }
    return tops.topBetween(low, high);
}

namespace {

// To follow a square takes longer than to place so many blocks in a picture.
constexpr double kBlocksOfCell = 16;
// Near an eye a block may be seen in all of them.
constexpr double kPlacesOfBlock = 64;

PixelBox bothOf(const PixelBox& a, const PixelBox& b) {
    return {glm::max(a.min, b.min), glm::min(a.max, b.max)};
}

}  // namespace

LineCells::LineCells(const PictureLines& lines, const RayVolume& volume, int side)
    : side_(side), box_(cellsOf(lines.seen())) {
    const glm::dvec2 size = box_.size();
    const auto blocks = double(volume.blocks.size());
    if (box_.empty() || blocks > kBlocksOfCell * size.x * size.y) return;
    std::vector<PixelBox> places;
    double placed = 0;
    for (const CodeBlock& block : volume.blocks) {
        const IndexBox voxels{8 * block.position, 8 * block.position + 7};
        places.push_back(bothOf(cellsOf(lines.seenOf(voxels)), box_));
        if (places.back().empty()) continue;
        const glm::dvec2 cells = places.back().size();
        placed += cells.x * cells.y;
        if (placed > size.x * size.y + kPlacesOfBlock * blocks) return;
    }
    const auto forPlaces = [&](const auto& use) {
        for (std::size_t i = 0; i < places.size(); ++i)
            for (int y = places[i].min.y; y < places[i].max.y; ++y)
                for (int x = places[i].min.x; x < places[i].max.x; ++x)
                    use(indexOf({x, y}), std::uint32_t(i));
    };
    ends_.resize(std::size_t(size.x) * std::size_t(size.y) + 1);
    forPlaces([&](std::size_t cell, std::uint32_t) { ++ends_[cell + 1]; });
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    blocks_.resize(ends_.back());
    // Each end is its cell's begin until all of the cell's blocks are there.
    forPlaces([&](std::size_t cell, std::uint32_t block) { blocks_[ends_[cell]++] = block; });
}

std::vector<std::uint32_t> LineCells::blocksBehind(const PixelBox& lines) const {
    std::vector<std::uint32_t> found;
    const PixelBox cells = bothOf(cellsOf(lines), box_);
    for (int y = cells.min.y; y < cells.max.y; ++y) {
        for (int x = cells.min.x; x < cells.max.x; ++x) {
            const std::size_t cell = indexOf({x, y});
            const std::size_t begin = cell > 0 ? ends_[cell - 1] : 0;
            found.insert(found.end(), blocks_.begin() + std::ptrdiff_t(begin),
                         blocks_.begin() + std::ptrdiff_t(ends_[cell]));
        }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

PixelBox LineCells::cellsOf(const PixelBox& lines) const {
    return {lines.min / side_, (lines.max + side_ - 1) / side_};
}

std::size_t LineCells::indexOf(glm::ivec2 cell) const {
    const glm::ivec2 place = cell - box_.min;
    return std::size_t(place.y) * std::size_t(box_.size().x) + std::size_t(place.x);
}

}  // namespace deltasplat
