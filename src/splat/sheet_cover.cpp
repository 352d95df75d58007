// SPDX-License-Identifier: Apache-2.0
// Based on: Franklin Crow, "Summed-Area Tables for Texture Mapping", 1984.
#include "splat/sheet_cover.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>

namespace deltasplat {

CoveredCells::CoveredCells(const PlaneBox& box) : box_(box) {
    if (!box.empty()) size_ = (box.size() + (kCellPixels - 1)) / kCellPixels;
    covered_.resize(std::size_t(size_.x) * std::size_t(size_.y));
    open_.resize(std::size_t(size_.x + 1) * std::size_t(size_.y + 1));
    settle();
}

PlaneBox CoveredCells::pixelsOf(glm::ivec2 cell) const {
    const glm::ivec2 first = box_.min + kCellPixels * cell;
    return {first, glm::min(first + kCellPixels, box_.max)};
}

glm::ivec2 CoveredCells::cellsOf(int axis, glm::ivec2 pixels) const {
    const auto placeOf = [&](int pixel) {
        return std::clamp(pixel, box_.min[axis], box_.max[axis]) - box_.min[axis];
    };
    return cellsOf({placeOf(pixels.x), placeOf(pixels.y)});
}

void CoveredCells::settle() {
    const std::size_t width = std::size_t(size_.x) + 1;
    for (int y = 0; y < size_.y; ++y) {
        std::uint32_t ofRow = 0;
        for (int x = 0; x < size_.x; ++x) {
            ofRow += isCovered({x, y}) ? 0 : 1;
            const std::size_t above = width * std::size_t(y) + std::size_t(x) + 1;
            open_[above + width] = open_[above] + ofRow;
        }
    }
}

namespace {

// Finds the cells that read a run of sheet pixels, and runs each `step` farther.
void findCells(const EvenReaders& readers, glm::ivec2 pixels, int step,
               std::span<glm::ivec2> cells) {
    for (glm::ivec2& place : cells) {
        place = CoveredCells::cellsOf(readers.of(pixels.x, pixels.y));
        pixels += step;
    }
}

}  // namespace

void SheetCover::set(const CoveredCells& cells, const SheetReading& first, const SheetReading& last,
                     const SheetLayout& layout) {
    cells_ = &cells;
    const PlaneBox& box = cells.box();
    for (int axis = 0; axis < 2; ++axis) {
        const auto find = [&](glm::ivec2 pixels, int step, std::vector<glm::ivec2>& places) {
            if (first.scale == 1 && last.scale == 1) {
                EvenReaders readers(first, axis, box);
                readers.add(EvenReaders(last, axis, box));
                return findCells(readers, pixels, step, places);
            }
            for (glm::ivec2& place : places) {
                glm::ivec2 readers = readersOf(first, axis, pixels.x, pixels.y, box);
                if (&first != &last) {
                    const glm::ivec2 others = readersOf(last, axis, pixels.x, pixels.y, box);
                    readers = {std::min(readers.x, others.x), std::max(readers.y, others.y)};
                }
                place = cells.cellsOf(axis, readers);
                pixels += step;
            }
        };
        blocks_[axis].resize(std::size_t(layout.blocks[axis]));
        find(pixelsReached(layout, 0), layout.blockPixels(), blocks_[axis]);
        tiles_[axis].resize(std::size_t(layout.tiles()[axis]));
        find({0, kTilePixels}, kTilePixels, tiles_[axis]);
    }
}

void SheetCover::clearHidden(int row, std::size_t words, std::span<std::uint64_t> rows) const {
    const Row hiding = tileRow(row);
    for (std::size_t i = 0; i < words; ++i) {
        std::uint64_t any = 0;
        for (std::size_t place = i; place < rows.size(); place += words) any |= rows[place];
        std::uint64_t hidden = 0;
        for (std::uint64_t rest = any; rest != 0; rest &= rest - 1) {
            const int bit = std::countr_zero(rest);
            if (hiding.hides(int(64 * i) + bit)) hidden |= std::uint64_t{1} << bit;
        }
        if (hidden == 0) continue;
        for (std::size_t place = i; place < rows.size(); place += words) rows[place] &= ~hidden;
    }
}

namespace {

glm::dvec2 startOf(const BasePlane& plane, const SheetLayout& layout, const SlicePlace& place) {
    const double r = layout.resolution;
    if (plane.isParallel()) return -(-place.offset * r - double(layout.marginPixels));
    return r * (place.scale * plane.positionOf({0, 0}) + place.offset) +
           double(layout.marginPixels) - layout.offsetPixels;
}

// Widens [low, high) by the reach of pixels [0, size) of a sheet along one axis.
void addReach(double start, double scale, int size, int least, int most, int& low, int& high) {
    const double first = std::floor((-1 - start) / scale) + 1;
    const double last = std::ceil((double(size) - start) / scale);
    low = int(std::clamp(first, double(least), double(low)));
    high = int(std::clamp(last, double(high), double(most)));
}

}  // namespace

SheetReading readingOf(const BasePlane& plane, const SheetLayout& layout, int slice) {
    const SlicePlace place = plane.placeOf(slice);
    const glm::dvec2 start = startOf(plane, layout, place);
    const glm::dvec2 whole = glm::floor(start);
    // Slices that nearly touch the eye are read at one place.
    const glm::dvec2 bounded = glm::clamp(whole, -2e9, 2e9);
    const double scale = plane.isParallel() ? 1 : place.scale * plane.spacing() * layout.resolution;
    return {glm::ivec2(bounded) - layout.origin, start - whole, scale, layout.origin};
}

PlaneBox reachOf(const BasePlane& plane, const SheetLayout& layout, int firstSlice,
                 int sliceCount) {
    const int lastSlice = firstSlice + sliceCount - 1;
    if (plane.isParallel()) {
        const glm::ivec2 first = -readingOf(plane, layout, firstSlice).offset;
        const glm::ivec2 last = -readingOf(plane, layout, lastSlice).offset;
        return {glm::min(first, last), glm::max(first, last) + layout.sizePixels};
    }
    // Slices between lie between, because all are scaled about one point.
    const PlaneBox& limits = plane.limits();
    PlaneBox reach{limits.max, limits.min};
    for (const int slice : {firstSlice, lastSlice}) {
        const SlicePlace place = plane.placeOf(slice);
        const glm::dvec2 start = startOf(plane, layout, place) - glm::dvec2(layout.origin);
        const double scale = place.scale * plane.spacing() * layout.resolution;
        for (int axis = 0; axis < 2; ++axis) {
            addReach(start[axis], scale, layout.sizePixels[axis], limits.min[axis],
                     limits.max[axis], reach.min[axis], reach.max[axis]);
        }
    }
    reach.max = glm::max(reach.max, reach.min);
    return reach;
}

SheetBox readBox(const SheetReading& reading, const PlaneBox& box, const SheetLayout& layout) {
    const double reach = readingReach(reading);
    SheetBox read;
    for (int axis = 0; axis < 2; ++axis) {
        // Rounded as by readers.
        const double start = reading.startOfWhole()[axis];
        const double origin = reading.origin[axis];
        const double size = layout.sizePixels[axis];
        const double first = std::floor(start + reading.scale * box.min[axis] - reach) + 1;
        const double last = std::floor(start + reading.scale * (box.max[axis] - 1) + reach) + 1;
        read.min[axis] = int(std::clamp(first - origin, 0.0, size));
        read.max[axis] = int(std::clamp(last - origin, 0.0, size));
    }
    return read;
}

glm::ivec2 readersOf(const SheetReading& reading, int axis, int first, int last,
                     const PlaneBox& box) {
    if (reading.scale == 1) return box.min[axis] + EvenReaders(reading, axis, box).of(first, last);
    const double start = reading.offset[axis] + reading.fraction[axis];
    const double reach = readingReach(reading);
    const auto bounded = [&](double pixel) {
        return int(std::clamp(pixel, double(box.min[axis]), double(box.max[axis])));
    };
    return {bounded(std::floor((first - reach - start) / reading.scale)),
            bounded(std::ceil((last - 1 + reach - start) / reading.scale) + 1)};
}

}  // namespace deltasplat
