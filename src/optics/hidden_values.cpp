// SPDX-License-Identifier: Apache-2.0
#include "optics/hidden_values.h"

#include <algorithm>

#include "deltasplat/ingest/value_statistics.h"
#include "optics/transfer_function.h"

namespace deltasplat {

bool hidesValues(const TransferFunction& function, bool hasRange) {
    using Point = TransferFunction::OpacityPoint;
    const std::vector<Point>& points = function.opacities;
    if (points.empty()) return false;
    // Opacity is constant beyond the first and the last point.
    const bool goesOn = hasRange || !function.normalized;
    const auto isClear = [](const Point& point) { return point.opacity == 0; };
    const Point& first = points.front();
    const Point& last = points.back();
    if (isClear(first) && (goesOn || first.x > 0)) return true;
    if (isClear(last) && (goesOn || last.x < 1)) return true;
    const auto clearBetween = [&](const Point& a, const Point& b) {
        return isClear(a) && isClear(b) && a.x < b.x;
    };
    return std::adjacent_find(points.begin(), points.end(), clearBetween) != points.end();
}

bool showsValue(const TransferFunction& function, const std::optional<glm::dvec2>& range,
                const std::string& type, double value) {
    if (!function.normalized) return function.opacityAt(value) > 0;
    const std::optional<glm::dvec2> ends = range ? range : rangeOfType(type);
    return ends && function.opacityAt((value - ends->x) / (ends->y - ends->x)) > 0;
}

double hiddenShare(const Volume& volume, const TransferFunction& function,
                   const std::optional<glm::dvec2>& range) {
    const std::optional<double> background = guessBackground(volume);
    std::uint64_t all = 0;
    std::uint64_t hidden = 0;
    for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
        if (volume.histogram[code] == 0) continue;
        if (background && volume.codeBook.standsFor(Code(code), *background)) continue;
        all += volume.histogram[code];
        if (!showsValue(function, range, volume.type, volume.codeBook.valueOf(Code(code))))
            hidden += volume.histogram[code];
    }
    return all > 0 ? double(hidden) / double(all) : 0;
}

}  // namespace deltasplat
