// SPDX-License-Identifier: Apache-2.0
#include "splat/word_colors.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "optics/color_digits.h"
#include "optics/digit_kernels.h"

namespace deltasplat {

namespace {

template <typename Use>
void forVoxels(std::uint64_t mask, const Use& use) {
    for (; mask != 0; mask &= mask - 1) use(std::size_t(std::countr_zero(mask)));
}

// Clears colours outside a mask.
void keepOnly(std::uint64_t mask, std::array<ClassTable::Color, 64>& colors) {
    if (mask == 0) {
        colors = {};
        return;
    }
    forVoxels(~mask, [&](std::size_t n) { colors[n] = {}; });
}

// Whether something is too thin or too dark for one plane.
bool needsTwoPlanes(const ClassTable& classes, const LookLight& light) {
    if (light.isFine()) return true;
    constexpr double kLeast = 8 * kLeastOfPlane;
    const VoxelUnits& units = light.units();
    const glm::dvec3 brightest = brightestOf(classes);
    for (std::size_t number = 0; number < classes.looks.size(); ++number) {
        const double alpha = units.alphaOf(std::uint16_t(number));
        if (!(alpha > 0)) continue;
        if (alpha < kLeast) return true;
        for (int c = 0; c < 3; ++c) {
            const double color = classes.looks[number].color[c];
            if (color > 0 && color / brightest[c] * alpha * light.dimmest() < kLeast) return true;
        }
    }
    return false;
}

}  // namespace

WordColors::WordColors(const PackedDeltas& deltas, const ClassTable& classes,
                       std::unique_ptr<const LookLight> light)
    : deltas_(&deltas), light_(std::move(light)) {
    const VoxelUnits& units = light_->units();
    table_.scale = units.scale();
    table_.looks.resize(1);
    table_.planes.resize(needsTwoPlanes(classes, *light_) ? 2 : 1);
    for (ClassTable::Plane& plane : table_.planes) plane.low.colors.resize(1);
}

void WordColors::light(std::size_t word, int slice,
                       const std::array<LitWord*, ClassTable::kMaxPlanes>& out) const {
    const DeltaWord& one = deltas_->words[word];
    WordUnits units;
    MoreDigits more;
    if (one.visible != 0) {
        light_->light(WordPlace(slice, 8 * one.block), one.classes, deltas_->looks[word], units);
        more = writeDigits(units, out[0]->high.data(), out[0]->low.data());
    }
    const std::uint64_t low = more.low & one.visible;
    keepOnly(one.visible, out[0]->high);
    keepOnly(low, out[0]->low);
    out[0]->any = one.visible;
    out[0]->anyLow = low;
    if (table_.planes.size() == 1) return;
    // Colours finer than the first plane's digits are written anew.
    *out[1] = {};
    constexpr ClassTable::Color kNothing{};
    forVoxels(more.planes & one.visible, [&](std::size_t n) {
        const std::uint64_t bit = std::uint64_t{1} << n;
        const ColorDigits digits = digitsOf({units[0][n], units[1][n], units[2][n], units[3][n]});
        out[0]->high[n] = digits[0];
        out[0]->low[n] = digits[1];
        out[1]->high[n] = digits[2];
        out[1]->low[n] = digits[3];
        if (digits[1] == kNothing) {
            out[0]->anyLow &= ~bit;
            if (digits[0] == kNothing) out[0]->any &= ~bit;
        }
        if (digits[3] != kNothing) out[1]->anyLow |= bit;
        if (digits[2] != kNothing || digits[3] != kNothing) out[1]->any |= bit;
    });
}

StepColors::StepColors(const PackedDeltas& deltas, ClassTable classes,
                       std::unique_ptr<const LookLight> light)
    : classes_(std::move(classes)) {
    if (light) own_.emplace(deltas, classes_, std::move(light));
}

}  // namespace deltasplat
