// SPDX-License-Identifier: Apache-2.0
#include "view_changes.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "delta/word_changes.h"
#include "memory.h"
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

struct ClassMatch {
    std::vector<ClassIndex> nowOfBefore;  // [classes], as compareWords has it
    bool isSameLight = false;             // what matches gives the same integers
};

// Whether colours that are stated can be told from what classes look like.
bool haveSameSteps(const ClassTable& before, const ClassTable& now) {
    return before.unitDistanceWorld == now.unitDistanceWorld &&
           before.extinctionScale == now.extinctionScale && before.stepWorld == now.stepWorld;
}

bool isSameLight(const StepColors& before, const StepColors& now) {
    return now.own() ? before.own()->isLike(*now.own())
                     : haveSameUnits(before.classes(), now.classes());
}

// Matches those of one slice. Slots that stand for other values than before match less.
std::vector<ClassIndex> matchLooks(const ClassTable& a, const ClassTable& b) {
    std::vector<ClassIndex> nowOfBefore(a.looks.size());
    const std::span<const Slot> before = a.classOfSlot();
    const std::span<const Slot> now = b.classOfSlot();
    const std::size_t slots = std::min(before.size(), now.size());
    for (std::size_t slot = 0; slot < slots; ++slot) {
        const Slot classBefore = before[slot];
        const Slot classNow = now[slot];
        if (classBefore == 0 || classNow == 0) continue;
        ClassIndex& matching = nowOfBefore[std::size_t(classBefore)];
        if (matching == 0 && a.looks[std::size_t(classBefore)] == b.looks[std::size_t(classNow)])
            matching = ClassIndex(classNow);
    }
    return nowOfBefore;
}

// Of levels that sums are rounded to, which are in order.
std::vector<ClassIndex> matchLevels(const ClassTable& a, const ClassTable& b) {
    std::vector<ClassIndex> nowOfBefore(a.looks.size());
    std::size_t now = 1;
    for (std::size_t before = 1; before < a.looks.size(); ++before) {
        const double extinction = a.looks[before].extinction;
        while (now < b.looks.size() && b.looks[now].extinction < extinction) ++now;
        if (now < b.looks.size() && a.looks[before] == b.looks[now])
            nowOfBefore[before] = ClassIndex(now);
    }
    return nowOfBefore;
}

// Of looks in any order, of which no two are alike.
std::vector<ClassIndex> matchAll(const ClassTable& a, const ClassTable& b) {
    const auto isBefore = [](const Look& one, const Look& other) {
        return std::tie(one.extinction, one.color.r, one.color.g, one.color.b) <
               std::tie(other.extinction, other.color.r, other.color.g, other.color.b);
    };
    std::vector<std::size_t> order(b.looks.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t one, std::size_t other) {
        return isBefore(b.looks[one], b.looks[other]);
    });
    std::vector<ClassIndex> nowOfBefore(a.looks.size());
    for (std::size_t before = 1; before < a.looks.size(); ++before) {
        const auto found = std::lower_bound(
            order.begin(), order.end(), a.looks[before],
            [&](std::size_t now, const Look& look) { return isBefore(b.looks[now], look); });
        if (found != order.end() && b.looks[*found] == a.looks[before])
            nowOfBefore[before] = ClassIndex(*found);
    }
    return nowOfBefore;
}

// Of pairs of classes that match.
std::vector<ClassIndex> matchPairs(const ClassTable& a, const ClassTable& b) {
    const std::vector<ClassIndex> single = matchLooks(a, b);
    std::vector<ClassIndex> nowOfBefore;
    nowOfBefore.reserve(a.size());
    const auto matches = [&](std::size_t i) { return i == 0 || single[i] != 0; };
    for (std::size_t first = 0; first < single.size(); ++first) {
        for (std::size_t second = 0; second < single.size(); ++second) {
            const std::size_t pair = single[first] * b.looks.size() + single[second];
            nowOfBefore.push_back(matches(first) && matches(second) ? ClassIndex(pair) : 0);
        }
    }
    return nowOfBefore;
}

// Matches classes that look alike.
ClassMatch matchClasses(const StepColors& before, const StepColors& now, const Subdivision& parts) {
    const ClassTable& a = before.classes();
    const ClassTable& b = now.classes();
    ClassMatch match{std::vector<ClassIndex>(a.size()), isSameLight(before, now)};
    if (now.own() && match.isSameLight) {
        // Then all have the same numbers.
        std::iota(match.nowOfBefore.begin(), match.nowOfBefore.end(), ClassIndex{0});
        return match;
    }
    const bool areLevels = b.oneColor && parts.joinedWithin == 1;
    match.nowOfBefore = b.pairs            ? matchPairs(a, b)
                        : parts.joined > 1 ? (areLevels ? matchLevels(a, b) : matchAll(a, b))
                                           : matchLooks(a, b);
    if (!match.isSameLight) return match;
    for (std::size_t i = 0; i < match.nowOfBefore.size(); ++i) {
        ClassIndex& matching = match.nowOfBefore[i];
        if (matching != 0 && !haveSameColor(a, Slot(i), b, Slot(matching))) matching = 0;
    }
    return match;
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

bool mayBeKept(const PictureView& view) {
    const SlabInput& slabs = view.slabs();
    const WordColors* own = slabs.splat.colors.own();
    if (own && !own->isLike(*own)) return false;
    const PackedDeltas& deltas = slabs.splat.deltas;
    double bytes = double(sizeof(DeltaWord)) * double(deltas.words.size());
    for (const auto& classes : deltas.storage) bytes += sizeof(ClassIndex) * double(classes.size());
    for (const auto& looks : deltas.lookStorage) bytes += sizeof(OwnLook) * double(looks.size());
    bytes += layerBytes(reachOfAll(slabs, seenSlabs(slabs)), slabs.layout.channels);
    constexpr double kShare = 0.125;
    return bytes <= kShare * double(availableMemory());
}

std::optional<ViewChanges> compareViews(const PictureView& before, const PictureView& now) {
    const SlabInput& a = before.slabs();
    const SlabInput& b = now.slabs();
    const StepColors& colorsBefore = a.splat.colors;
    const StepColors& colorsNow = b.splat.colors;
    if (a.layout != b.layout || a.plane != b.plane || a.splat.footprint != b.splat.footprint ||
        !haveSameSlabs(a.splat.deltas, b.splat.deltas) ||
        (colorsBefore.own() == nullptr) != (colorsNow.own() == nullptr) ||
        before.axis().parts.joined != now.axis().parts.joined ||
        before.axis().parts.joinedWithin != now.axis().parts.joinedWithin ||
        before.axis().parts.slants != now.axis().parts.slants ||
        colorsBefore.classes().pairs != colorsNow.classes().pairs ||
        !haveSameSteps(colorsBefore.classes(), colorsNow.classes())) {
        return {};
    }
    const std::vector<SeenSlab> seen = seenSlabs(b);
    const PlaneBox reach = reachOfAll(b, seen);
    const glm::ivec2 all(reach.min.y, reach.max.y);
    // Of what is out of sight nothing is kept, either.
    if (reach.empty()) return ViewChanges{all, all, 0, 0};
    const ClassMatch match = matchClasses(colorsBefore, colorsNow, now.axis().parts);
    const std::vector<SlabChanges> slabs =
        compareWords(a.splat.deltas, b.splat.deltas, match.nowOfBefore);
    const glm::ivec2 none(all.y, all.x);
    ViewChanges changes{match.isSameLight ? none : all, none, 0, 0};
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
