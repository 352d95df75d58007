// SPDX-License-Identifier: Apache-2.0
// Based on: P. Sabella, A Rendering Algorithm for Visualizing 3D Scalar Fields, 1988 (absorption
// along a ray), with the opacity correction for the distance between slices of P. Lacroute, Fast
// Volume Rendering Using a Shear-Warp Factorization, 1995.
#include "deltasplat/optics/class_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "deltasplat/error.h"
#include "number_text.h"

namespace deltasplat {
namespace {

void requireThat(bool holds, const char* flag, const std::string& got, const char* expected) {
    if (!holds) throw Error(ErrorCode::kUsage, gotExpected(flag, got, expected));
}

void checkOptics(const Optics& optics) {
    if (optics.unitDistance) {
        const double unit = *optics.unitDistance;
        requireThat(std::isfinite(unit) && unit > 0, "--unit-distance", numberText(unit),
                    "a number > 0");
    }
    const double extinction = optics.extinctionScale;
    requireThat(std::isfinite(extinction) && extinction >= 0, "--extinction",
                numberText(extinction), "a number >= 0");
    if (optics.range) {
        const glm::dvec2 range = *optics.range;
        requireThat(std::isfinite(range.x) && std::isfinite(range.y) && range.x < range.y,
                    "--range", numberText(range), "LO,HI with LO < HI");
    }
}

double smallest(const glm::dvec3& v) {
    return std::min({v.x, v.y, v.z});
}

// The share of light taken away on the way from one slice to the next. Written without the
// extinction itself, so that opacity 1 (infinite extinction) and thin fog are both exact.
double alphaOf(double opacity, double unitDistancesPerSlice) {
    if (opacity <= 0 || unitDistancesPerSlice <= 0) return 0;
    if (opacity >= 1) return 1;
    return -std::expm1(std::log1p(-opacity) * unitDistancesPerSlice);
}

using Rgba = std::array<double, 4>;

// Premultiplied colour of every slot, before it is rounded.
std::vector<Rgba> classifyExactly(const Volume& volume, const Optics& optics,
                                  double unitDistancesPerSlice) {
    const TransferFunction& function = optics.transferFunction;
    const glm::dvec2 range =
        function.normalized ? optics.range.value_or(defaultRange(volume)) : glm::dvec2(0, 1);
    std::vector<Rgba> exact(kSlotCount, Rgba{});
    for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
        if (volume.histogram[code] == 0) continue;
        const double value = volume.codeBook.valueOf(Code(code));
        const double x = function.normalized
                             ? (0.5 * value - 0.5 * range.x) / (0.5 * range.y - 0.5 * range.x)
                             : value;
        const double alpha = alphaOf(function.opacityAt(x), unitDistancesPerSlice);
        if (alpha == 0) continue;
        const glm::dvec3 rgb = alpha * function.colorAt(x);
        exact[code + 1] = {rgb.r, rgb.g, rgb.b, alpha};
    }
    return exact;
}

std::uint64_t packed(const std::array<std::uint16_t, 4>& entry) {
    return std::uint64_t{entry[0]} << 48 | std::uint64_t{entry[1]} << 32 |
           std::uint64_t{entry[2]} << 16 | entry[3];
}

}  // namespace

ClassTable classify(const Volume& volume, const Optics& optics, double sliceStepWorld) {
    checkOptics(optics);
    const double unitDistance = optics.unitDistance.value_or(smallest(volume.voxelSize()));
    const std::vector<Rgba> exact =
        classifyExactly(volume, optics, optics.extinctionScale * (sliceStepWorld / unitDistance));

    ClassTable table;
    table.entries.assign(kSlotCount, {});
    for (int channel = 0; channel < 4; ++channel) {
        double largest = 0;
        for (const Rgba& rgba : exact) largest = std::max(largest, rgba[channel]);
        table.scale[channel] = largest / ClassTable::kMax;

        // What is too small for a scale is nothing.
        if (table.scale[channel] == 0) continue;
        for (int slot = 0; slot < kSlotCount; ++slot) {
            table.entries[slot][channel] =
                std::uint16_t(std::lround(exact[slot][channel] / largest * ClassTable::kMax));
        }
    }
    return table;
}

std::vector<Slot> mergeAlikeSlots(const ClassTable& table) {
    // Most slots are empty, and those that are not are few or sorted cheaply; equal entries end up
    // together with the smallest slot first.
    std::vector<std::pair<std::uint64_t, Slot>> visible;
    for (std::size_t slot = 0; slot < table.entries.size(); ++slot) {
        const std::uint64_t key = packed(table.entries[slot]);
        if (key != 0) visible.emplace_back(key, Slot(slot));
    }
    std::sort(visible.begin(), visible.end());

    std::vector<Slot> slotMap(table.entries.size(), kEmptySlot);
    for (std::size_t i = 0; i < visible.size(); ++i) {
        const bool alike = i > 0 && visible[i].first == visible[i - 1].first;
        slotMap[visible[i].second] = alike ? slotMap[visible[i - 1].second] : visible[i].second;
    }
    return slotMap;
}

}  // namespace deltasplat
