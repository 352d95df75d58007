// SPDX-License-Identifier: Apache-2.0
#include "optics/hold_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "deltasplat/error.h"
#include "number_text.h"

namespace deltasplat {
namespace {

void checkTolerance(const Tolerance& tolerance) {
    if (!(tolerance.relative >= 0 && tolerance.relative < 1)) {
        throw Error(ErrorCode::kUsage, gotExpected("--tolerance", numberText(tolerance.relative),
                                                   "a number from 0 to less than 1"));
    }
    if (!(tolerance.value >= 0 && std::isfinite(tolerance.value))) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("--tolerance-value", numberText(tolerance.value), "a number >= 0"));
    }
}

bool looksWithin(const glm::dvec4& held, const glm::dvec4& color, double tolerance) {
    for (int c = 0; c < 4; ++c) {
        if (std::abs(held[c] - color[c]) > tolerance * color[c]) return false;
    }
    return true;
}

// What the codes of a volume stand for, [kSlotCount]; 0 for those that do not occur.
std::vector<double> valuesOfSlots(const Volume& volume) {
    std::vector<double> values(kSlotCount);
    for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
        if (volume.histogram[code] != 0) values[code + 1] = volume.codeBook.valueOf(Code(code));
    }
    return values;
}

}  // namespace

std::function<bool(Slot, Slot)> holdRule(const Volume& volume, const ClassTable& classes,
                                         const Tolerance& tolerance) {
    checkTolerance(tolerance);
    if (tolerance.isExact()) return {};
    const auto looksAlike = [&classes, t = tolerance.relative](Slot held, Slot slot) {
        const auto colorOf = [&](Slot s) { return classes.unitsOf(classes.classOfSlot[s]); };
        return looksWithin(colorOf(held), colorOf(slot), t);
    };
    if (tolerance.value == 0) return looksAlike;
    return [=, values = valuesOfSlots(volume)](Slot held, Slot slot) {
        return std::abs(values[held] - values[slot]) <= tolerance.value &&
               (tolerance.relative == 0 || looksAlike(held, slot));
    };
}

ErrorBound errorBound(const ClassTable& classes, const Tolerance& tolerance) {
    if (tolerance.isExact()) return {};
    if (tolerance.relative == 0) {
        const double unknown = std::numeric_limits<double>::infinity();
        return {unknown, unknown};
    }
    double brightest = 0;
    for (std::size_t i = 0; i < classes.size(); ++i) {
        const glm::dvec4 color = classes.unitsOf(Slot(i));
        for (int c = 0; color.a != 0 && c < 3; ++c) {
            const double light = color[c] * classes.scale[c] / (color.a * classes.scale.a);
            brightest = std::max(brightest, light);
        }
    }
    const double t = tolerance.relative;
    return {(classes.oneColor ? 1 : 2) * t * brightest, t};
}

}  // namespace deltasplat
