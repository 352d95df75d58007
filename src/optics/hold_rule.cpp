// SPDX-License-Identifier: Apache-2.0
#include "optics/hold_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/portable_math.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "optics/color_digits.h"
#include "optics/voxel_painter.h"

namespace deltasplat {
namespace {

void checkTolerance(const Tolerance& tolerance) {
    if (!(tolerance.relative >= 0 && tolerance.relative < 1)) {
        throw Error(ErrorCode::kUsage, "`tolerance.relative`", numberText(tolerance.relative),
                    "a number from 0 to less than 1");
    }
    if (!(tolerance.value >= 0 && std::isfinite(tolerance.value))) {
        throw Error(ErrorCode::kUsage, "`tolerance.value`", numberText(tolerance.value),
                    "a number >= 0");
    }
}

bool looksWithin(const glm::dvec4& held, const glm::dvec4& color, double tolerance) {
    for (int c = 0; c < 4; ++c) {
        if (std::abs(held[c] - color[c]) > tolerance * color[c]) return false;
    }
    return true;
}

// Values of a volume's codes, [kSlotCount]; 0 for codes that do not occur.
std::vector<double> valuesOfSlots(const Volume& volume) {
    std::vector<double> values(kSlotCount);
    for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
        if (volume.histogram()[code] != 0) values[code + 1] = volume.codeBook().valueOf(Code(code));
    }
    return values;
}

// Upper bound of the error of 1 - (1 - a)^w for any w in 0..1 if opacity a is off by t a: that
// error times the steepest slope. At a = 1 there is no bound.
double shorterStep(double mostOpaque, double t) {
    const double clear = 1 - (1 + t) * mostOpaque;
    if (!(clear > 0)) return std::numeric_limits<double>::infinity();
    // The w that maximizes w clear^(w - 1).
    const double w = std::min(1.0, -1 / portable::log(clear));
    return t * mostOpaque * w * portable::pow(clear, w - 1);
}

}  // namespace

std::function<bool(Slot, Slot)> holdRule(const Volume& volume, const ClassTable& classes,
                                         const Tolerance& tolerance) {
    checkTolerance(tolerance);
    if (tolerance.isExact()) return {};
    const auto looksAlike = [&classes, t = tolerance.relative](Slot held, Slot slot) {
        const auto colorOf = [&](Slot s) { return classes.unitsOf(classes.classOfSlot()[s]); };
        return looksWithin(colorOf(held), colorOf(slot), t);
    };
    if (tolerance.value == 0) return looksAlike;
    return [=, values = valuesOfSlots(volume)](Slot held, Slot slot) {
        return std::abs(values[held] - values[slot]) <= tolerance.value &&
               (tolerance.relative == 0 || looksAlike(held, slot));
    };
}

std::function<bool(const VoxelLook&, const VoxelLook&)> looksHoldRule(const VoxelUnits& units,
                                                                      const Tolerance& tolerance) {
    if (tolerance.isExact()) return {};
    if (tolerance.relative == 0) {
        return [](const VoxelLook& held, const VoxelLook& look) { return held.own == look.own; };
    }
    const auto lightOf = [units](const VoxelLook& look) {
        return unitsOf(
            digitsOf(glm::dvec4(units.unitsOf(look.number, glm::vec3(colorOfLook(look.own))))));
    };
    return [lightOf, t = tolerance.relative](const VoxelLook& held, const VoxelLook& look) {
        return looksWithin(lightOf(held), lightOf(look), t);
    };
}

ErrorBound errorBound(const ClassTable& classes, const Tolerance& tolerance, Steps steps,
                      std::optional<double> ownBrightest) {
    if (tolerance.isExact()) return {};
    if (tolerance.relative == 0) return kUnknownError;
    double brightest = 0;
    double mostOpaque = 0;
    for (std::size_t i = 0; i < classes.size(); ++i) {
        const glm::dvec4 color = classes.unitsOf(Slot(i));
        mostOpaque = std::max(mostOpaque, color.a * classes.scale.a);
        for (int c = 0; color.a != 0 && c < 3; ++c) {
            const double light = color[c] * classes.scale[c] / (color.a * classes.scale.a);
            brightest = std::max(brightest, light);
        }
    }
    // Rounding keeps colour / opacity within 2^-8 (ClassTable).
    if (ownBrightest) brightest = (1 + 0x1p-7) * *ownBrightest;
    const double t = tolerance.relative;
    const double colors = classes.oneColor                ? 0
                          : steps == Steps::kAsClassified ? t
                                                          : 2 * t / (1 - t);
    const double shorter = steps == Steps::kOneShorter ? shorterStep(mostOpaque, t) : 0;
    return {(t + colors + shorter * (classes.oneColor ? 1 : 2 + colors)) * brightest, t + shorter};
}

}  // namespace deltasplat
