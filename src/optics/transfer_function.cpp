// SPDX-License-Identifier: Apache-2.0
// Based on: VTK's documentation and behaviour of vtkPiecewiseFunction (midpoint and sharpness of an
// opacity point).
#include "optics/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "base/default_floats.h"
#include "base/portable_math.h"
#include "deltasplat/ingest/value_statistics.h"
#include "deltasplat/optics/default_ramp.h"
#include "deltasplat/optics/transfer_function.h"
#include "optics/color_curve.h"
#include "volume/code_counts.h"

namespace deltasplat {

namespace {

// Finds the points around x: `right` is the first point beyond x, so that of several points at the
// same x the last one counts.
template <typename Point>
typename std::vector<Point>::const_iterator firstBeyond(const std::vector<Point>& points,
                                                        double x) {
    return std::upper_bound(points.begin(), points.end(), x,
                            [](double value, const Point& point) { return value < point.x; });
}

// Bends the way from one point to the next so that its middle is reached at `midpoint`.
double bendToMidpoint(double s, double midpoint) {
    const double m = std::clamp(midpoint, 1e-5, 1 - 1e-5);
    return s < m ? 0.5 * s / m : 0.5 + 0.5 * (s - m) / (1 - m);
}

// Blends with a cubic whose ends get flatter and whose middle gets steeper with sharpness.
double sharpBlend(double from, double to, double s, double sharpness) {
    const double power = 1 + 10 * sharpness;
    const double t =
        s < 0.5 ? 0.5 * portable::pow(2 * s, power) : 1 - 0.5 * portable::pow(2 * (1 - s), power);
    const double rise = t * t * (3 - 2 * t);
    const double slopes = t * (t - 1) * (2 * t - 1);
    const double value = from + (to - from) * (rise + (1 - sharpness) * slopes);
    return std::clamp(value, std::min(from, to), std::max(from, to));
}

// How often each code occurs, what is cut off included: of a volume that was cut counting takes a
// walk, so it is asked for once.
using Counts = std::vector<std::uint64_t>;

// As bulkRange.
glm::dvec2 bulkOf(const Volume& volume, Counts counts) {
    for (std::size_t code = 0; code < counts.size(); ++code) {
        if (volume.codeBook.standsFor(Code(code), volume.background)) counts[code] = 0;
    }
    if (std::all_of(counts.begin(), counts.end(), [](std::uint64_t count) { return count == 0; }))
        return {volume.background, volume.background + 1};
    return {volume.codeBook.valueOf(percentileCode(counts, 1)),
            volume.codeBook.valueOf(percentileCode(counts, 99))};
}

// As rampRange.
glm::dvec2 rampOf(const Volume& volume, const Counts& counts) {
    glm::dvec2 range = bulkOf(volume, counts);
    if (isFog(volume) && volume.background < range.y) range.x = volume.background;
    return range;
}

// Whether most values lie around 0, of cells of the same width, one of which has 0 in its middle.
bool mostAreNearZero(const Volume& volume, const glm::dvec2& ends, const Counts& counts) {
    constexpr int kCells = 8;
    const auto cellOf = [&](double value) {
        return kCells + int(std::round(kCells * (value / (ends.y - ends.x))));
    };
    std::vector<std::uint64_t> cells(2 * kCells + 1);
    for (std::size_t code = 0; code < counts.size(); ++code) {
        const double value = counts[code] == 0 ? ends.y : volume.codeBook.valueOf(Code(code));
        if (counts[code] != 0 && value >= ends.x && value <= ends.y)
            cells[cellOf(value)] += counts[code];
    }
    return std::max_element(cells.begin(), cells.end()) == cells.begin() + cellOf(0);
}

// Whether values lie on both sides of 0, which stands for nothing: a map of z values, a difference.
// A side that is less than a tenth of the other is no side: filters overshoot that far.
bool divergesFromZero(const Volume& volume, const glm::dvec2& bulk, const Counts& counts) {
    constexpr double kLeastSide = 0.1;
    const double least = kLeastSide * std::max(-bulk.x, bulk.y);
    if (!(-bulk.x >= least && bulk.y >= least && bulk.x < 0 && bulk.y > 0)) return false;
    const std::optional<double> background = guessBackground(volume);
    return background ? *background == 0 : mostAreNearZero(volume, bulk, counts);
}

// Clear at 0, the same blue and red as those of the preset coolwarm at the farther of two ends.
TransferFunction divergingRamp(const glm::dvec2& range) {
    const double end = std::max(-range.x, range.y);
    TransferFunction ramp;
    ramp.name = "diverging ramp";
    ramp.colorSpace = ColorSpace::kDiverging;
    ramp.colors = {{-end, {0.230, 0.299, 0.754}}, {end, {0.706, 0.016, 0.150}}};
    ramp.opacities = {{-end, kRampOpacity, 0.5, 0}, {0, 0, 0.5, 0}, {end, kRampOpacity, 0.5, 0}};
    return ramp;
}

TransferFunction greyRamp(const glm::dvec2& range) {
    TransferFunction ramp;
    ramp.name = "grey ramp";
    ramp.linearColors = true;
    ramp.colors = {{range.x, glm::dvec3(0)}, {range.y, glm::dvec3(1)}};
    ramp.opacities = {{range.x, 0, 0.5, 0}, {range.y, kRampOpacity, 0.5, 0}};
    return ramp;
}

}  // namespace

glm::dvec3 TransferFunction::colorAt(double x) const {
    return ColorCurve(*this).at(x);
}

bool TransferFunction::colorsJump() const {
    if (categorical) return true;
    // As close as "Step" puts the points of a jump, and closer than anybody else would.
    constexpr double kShare = 0x1p-30;
    for (std::size_t i = 1; i < colors.size(); ++i) {
        const double apart = colors[i].x - colors[i - 1].x;
        const double range = colors.back().x - colors.front().x;
        if (apart > kShare * range || colors[i].rgb == colors[i - 1].rgb) continue;
        // What is clear has no colour.
        constexpr double kFar = std::numeric_limits<double>::max();
        if (opacityAt(std::nextafter(colors[i - 1].x, -kFar)) > 0 &&
            opacityAt(std::nextafter(colors[i].x, kFar)) > 0)
            return true;
    }
    return false;
}

double TransferFunction::opacityAt(double x) const {
    const auto right = firstBeyond(opacities, x);
    if (right == opacities.begin()) return opacities.front().opacity;
    if (right == opacities.end()) return opacities.back().opacity;

    // The left point's midpoint and sharpness shape the way to the right one; VTK takes the ends of
    // the sharpness' range for a straight line and for a step.
    const OpacityPoint& left = right[-1];
    const double s = bendToMidpoint(wayBetween(left.x, right->x, x), left.midpoint);
    if (left.sharpness < 0.01) return std::lerp(left.opacity, right->opacity, s);
    if (left.sharpness > 0.99) return s < 0.5 ? left.opacity : right->opacity;
    return sharpBlend(left.opacity, right->opacity, s, left.sharpness);
}

bool isFog(const Volume& volume) {
    return volume.gridClass == "fog volume" ||
           (volume.hasBackground && volume.gridClass == "unknown" && volume.space.empty() &&
            volume.name == "density");
}

bool isHounsfield(const Volume& volume) {
    if (volume.space.empty() || volume.empty()) return false;
    const std::vector<std::uint64_t> counts = uncutHistogram(volume);
    const double all = std::accumulate(counts.begin(), counts.end(), 0.0);
    const auto shareWithin = [&](double low, double high) {
        double count = 0;
        for (std::size_t code = 0; code < counts.size(); ++code) {
            if (counts[code] == 0) continue;
            const double value = volume.codeBook.valueOf(Code(code));
            if (value >= low && value <= high) count += double(counts[code]);
        }
        return count / all;
    };
    return shareWithin(-1100, -900) >= 0.01 && shareWithin(-200, 300) >= 0.02;
}

glm::dvec2 bulkRange(const Volume& volume) {
    return bulkOf(volume, uncutHistogram(volume));
}

glm::dvec2 rampRange(const Volume& volume) {
    return rampOf(volume, uncutHistogram(volume));
}

TransferFunction defaultRamp(const Volume& volume) {
    const DefaultFloats floats;
    const Counts counts = uncutHistogram(volume);
    const glm::dvec2 range = rampOf(volume, counts);
    if (!isFog(volume) && divergesFromZero(volume, range, counts)) return divergingRamp(range);
    return defaultRamp(volume, range);
}

TransferFunction defaultRamp(const Volume& volume, const glm::dvec2& range) {
    TransferFunction ramp = greyRamp(range);
    if (!isFog(volume)) return ramp;
    // Thin fog lets more of what is behind it through; it does not grow dark.
    ramp.name = "white ramp";
    ramp.colors = {{range.x, glm::dvec3(1)}};
    return ramp;
}

TransferFunction wholeRamp(const Volume& volume) {
    const DefaultFloats floats;
    return wholeRamp(volume, {volume.valueMin, volume.valueMax});
}

TransferFunction wholeRamp(const Volume&, const glm::dvec2& range) {
    TransferFunction ramp = greyRamp(range);
    ramp.linearColors = false;
    return ramp;
}

glm::dvec2 defaultRange(const Volume& volume) {
    if (const auto all = rangeOfType(volume.type)) return *all;
    glm::dvec2 range(volume.valueMin, volume.valueMax);
    if (volume.hasBackground) {
        range = {std::min(range.x, volume.background), std::max(range.y, volume.background)};
    }

    // One value only: nothing should be as clear as 0, and anything else as dense as the largest.
    if (range.x == range.y) range = {std::min(range.x, 0.0), std::max(range.y, 0.0)};
    return range.x < range.y ? range : glm::dvec2(0, 1);
}

}  // namespace deltasplat
