// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec2.hpp>

#include "splat/sheet.h"
#include "view/base_plane.h"

namespace deltasplat {

/// Where the base plane reads one slice's sheet, or a part of it: base pixel b at scale * b +
/// offset + fraction.
struct SheetReading {
    glm::ivec2 offset{0};
    glm::dvec2 fraction{0.0};  ///< 0 <= fraction < 1
    double scale = 1;          ///< exactly 1 in parallel projection
    glm::ivec2 origin{0};      ///< as SheetLayout::origin, of the part

    /// Where base pixel 0 reads the whole sheet. Places that are scaled are rounded: those of the
    /// whole, lest parts differ from it.
    glm::dvec2 startOfWhole() const { return glm::dvec2(offset) + glm::dvec2(origin) + fraction; }
};

SheetReading readingOf(const BasePlane& plane, const SheetLayout& layout, int slice);

/// Returns the base plane pixels that any of `sliceCount` slices from `firstSlice` on can reach, as
/// far as the plane goes.
PlaneBox reachOf(const BasePlane& plane, const SheetLayout& layout, int firstSlice, int sliceCount);

/// Returns the sheet pixels, of those that there are, that the pixels of a box read.
SheetBox readBox(const SheetReading& reading, const PlaneBox& box, const SheetLayout& layout);

/// Returns the base plane pixels [x, y) along an axis, of those of a box, that read any of the
/// sheet pixels [first, last).
glm::ivec2 readersOf(const SheetReading& reading, int axis, int first, int last,
                     const PlaneBox& box);

/// What readersOf() returns at scale 1, for many runs of sheet pixels: those that read [first,
/// last) are the box's pixels [first + before, last + after), counted from its first.
struct EvenReaders {
    EvenReaders(const SheetReading& reading, int axis, const PlaneBox& box)
        : count(box.size()[axis]) {
        // Where the plane lies farther away than that, the box has none of the pixels: neither it
        // nor a sheet has as many along an axis.
        constexpr std::int64_t kFar = 1 << 29;
        const std::int64_t shift = std::int64_t{reading.offset[axis]} + box.min[axis];
        before = int(std::clamp(-shift - (reading.fraction[axis] > 0 ? 2 : 1), -kFar, kFar));
        after = int(std::clamp(1 - shift, -kFar, kFar));
    }
    /// Becomes those that read at either place.
    void add(const EvenReaders& other) {
        before = std::min(before, other.before);
        after = std::max(after, other.after);
    }
    /// Returns those of the box, [x, y).
    glm::ivec2 of(int first, int last) const {
        return {std::clamp(first + before, 0, count), std::clamp(last + after, 0, count)};
    }

    int before;
    int after;
    int count;  ///< the box's
};

/// How far a reading reaches to both sides of a position, in sheet pixels: to the neighbours, or,
/// where base pixels lie farther apart, to the next of those.
inline double readingReach(const SheetReading& reading) {
    return reading.scale > 1 ? reading.scale : 1;
}

}  // namespace deltasplat
