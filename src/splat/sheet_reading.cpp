// SPDX-License-Identifier: Apache-2.0
#include "splat/sheet_reading.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace deltasplat {
namespace {

// Where the base plane's pixel (0, 0) reads the whole sheet.
glm::dvec2 startOf(const BasePlane& plane, const SheetLayout& layout, const SlicePlace& place) {
    const double r = layout.resolution;
    if (plane.isParallel()) return -(-place.offset * r - double(layout.marginPixels));
    return r * (place.scale * plane.positionOf({0, 0}) + place.offset) +
           double(layout.marginPixels) - layout.offsetPixels;
}

// What is reached of one axis, by pixels [0, size) of a sheet.
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
    // Slices between lie between, for they are scaled about one point.
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
        // Rounded as who reads rounds them.
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
