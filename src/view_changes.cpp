// SPDX-License-Identifier: Apache-2.0
#include "view_changes.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "delta/word_changes.h"
#include "splat/sheet_reading.h"

namespace deltasplat {
namespace {

using Digit = ClassTable::Digit;

bool haveSameColor(const Digit& before, Slot classBefore, const Digit& now, Slot classNow) {
    return before.colors.empty() ||
           before.colors[std::size_t(classBefore)] == now.colors[std::size_t(classNow)];
}

bool haveSameColor(const ClassTable& before, Slot classBefore, const ClassTable& now,
                   Slot classNow) {
    for (std::size_t plane = 0; plane < now.planes.size(); ++plane) {
        const ClassTable::Plane& a = before.planes[plane];
        const ClassTable::Plane& b = now.planes[plane];
        if (!haveSameColor(a.high, classBefore, b.high, classNow) ||
            !haveSameColor(a.low, classBefore, b.low, classNow)) {
            return false;
        }
    }
    return true;
}

// Whether colours are stated in the same units and digits.
bool haveSameUnits(const ClassTable& before, const ClassTable& now) {
    return before.oneColor == now.oneColor && before.scale == now.scale &&
           std::equal(before.planes.begin(), before.planes.end(), now.planes.begin(),
                      now.planes.end(), [](const auto& a, const auto& b) {
                          return a.high.colors.empty() == b.high.colors.empty() &&
                                 a.low.colors.empty() == b.low.colors.empty();
                      });
}

// Returns which of the classes now a class before is the same as, [classes]; 0 if none; nothing if
// no colours can be the same.
std::vector<ClassIndex> matchClasses(const StepColors& before, const StepColors& now) {
    const ClassTable& a = before.classes();
    const ClassTable& b = now.classes();
    std::vector<ClassIndex> nowOfBefore;
    if ((before.own() == nullptr) != (now.own() == nullptr)) return nowOfBefore;
    if (now.own()) {
        if (!before.own()->isLike(*now.own())) return nowOfBefore;
        // What is lit alike has the same classes.
        nowOfBefore.resize(a.size());
        for (std::size_t number = 0; number < a.size(); ++number)
            nowOfBefore[number] = ClassIndex(number);
        return nowOfBefore;
    }
    if (!haveSameUnits(a, b)) return nowOfBefore;
    nowOfBefore.resize(a.size());
    const std::size_t slots = std::min(a.classOfSlot.size(), b.classOfSlot.size());
    for (std::size_t slot = 0; slot < slots; ++slot) {
        const Slot classBefore = a.classOfSlot[slot];
        const Slot classNow = b.classOfSlot[slot];
        if (classBefore == 0 || classNow == 0 || nowOfBefore[std::size_t(classBefore)] != 0)
            continue;
        if (haveSameColor(a, classBefore, b, classNow))
            nowOfBefore[std::size_t(classBefore)] = ClassIndex(classNow);
    }
    return nowOfBefore;
}

// Adds to rows of the base plane those that see any of some rows of blocks in a slab.
void addRows(const SlabInput& input, const SeenSlab& seen, glm::ivec2 blockRows,
             const PlaneBox& reach, glm::ivec2& rows) {
    if (blockRows.y <= blockRows.x) return;
    const SheetLayout& layout = input.layout;
    const int firstBlock = layout.firstVoxel.y / 8;
    const int first = pixelsReached(layout, blockRows.x - firstBlock).x;
    const int last = pixelsReached(layout, blockRows.y - 1 - firstBlock).y;
    // Slices between lie between.
    for (const int slice : {seen.firstSlice, seen.lastSlice}) {
        const glm::ivec2 readers =
            readersOf(readingOf(input.plane, layout, slice), 1, first, last, reach);
        rows = {std::min(rows.x, readers.x), std::max(rows.y, readers.y)};
    }
}

}  // namespace

ViewChanges compareViews(const PictureView& before, const PictureView& now) {
    const SlabInput& a = before.slabs();
    const SlabInput& b = now.slabs();
    const std::vector<SeenSlab> seen = seenSlabs(b);
    const PlaneBox reach = reachOfAll(b, seen);
    const glm::ivec2 all(reach.min.y, reach.max.y);
    // Of what is out of sight nothing is kept, either.
    if (reach.empty()) return {all, all, 0, 0};
    ViewChanges changes{all, all, 1, 1};
    if (a.layout != b.layout || a.plane != b.plane || a.splat.footprint != b.splat.footprint ||
        !haveSameSlabs(a.splat.deltas, b.splat.deltas)) {
        return changes;
    }
    const std::vector<ClassIndex> nowOfBefore = matchClasses(a.splat.colors, b.splat.colors);
    if (nowOfBefore.empty()) return changes;
    const std::vector<SlabChanges> slabs =
        compareWords(a.splat.deltas, b.splat.deltas, nowOfBefore);
    const glm::ivec2 none(all.y, all.x);
    changes = {none, none, 0, 0};
    for (const SlabChanges& slab : slabs) {
        changes.differing += slab.differing;
        changes.shown += slab.shown;
    }
    for (const SeenSlab& one : seen) {
        const SlabChanges& slab = slabs[std::size_t(one.slab - b.splat.deltas.slabs.data())];
        addRows(b, one, slab.differingRows, reach, changes.differingRows);
        addRows(b, one, slab.shownRows, reach, changes.shownRows);
    }
    return changes;
}

}  // namespace deltasplat
