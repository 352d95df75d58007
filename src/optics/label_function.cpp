// SPDX-License-Identifier: Apache-2.0
#include "optics/label_function.h"

#include <algorithm>
#include <iterator>

namespace deltasplat {

TransferFunction labelFunction(const std::vector<LabelLook>& looks) {
    TransferFunction function;
    function.categorical = true;
    // Of several points at the same place the last one counts.
    function.opacities = {{looks.front().label - 0.5, 0, 0.5, 0}};
    for (const LabelLook& look : looks) {
        const double begin = look.label - 0.5;
        const double end = look.label + 0.5;
        for (const double x : {begin, end}) function.colors.push_back({x, look.rgb});
        auto& opacities = function.opacities;
        const std::size_t last = opacities.size() - 1;
        if (last > 0 && opacities[last].x == begin && opacities[last - 1].opacity == look.opacity) {
            // As opaque as the label before: no step between them.
            opacities.resize(last - 1);
        } else {
            if (opacities.back().x < begin) opacities.push_back({begin, 0, 0.5, 0});
            opacities.push_back({begin, look.opacity, 0.5, 0});
        }
        opacities.push_back({end, look.opacity, 0.5, 0});
        opacities.push_back({end, 0, 0.5, 0});
    }
    return function;
}

TransferFunction withColors(const TransferFunction& function, const LabelList& labels) {
    TransferFunction colored = function;
    for (const LabelEntry& label : labels.entries) {
        if (!label.rgb) continue;
        // Each label has a colour at either end.
        const auto begin = std::ranges::lower_bound(colored.colors, double(label.value) - 0.5, {},
                                                    &TransferFunction::ColorPoint::x);
        if (std::distance(begin, colored.colors.end()) < 2 || begin->x != double(label.value) - 0.5)
            continue;
        // The end of the label before lies at the same place.
        const auto own = begin[1].x == begin->x ? begin + 1 : begin;
        if (std::distance(colored.colors.begin(), own) % 2 != 0) continue;
        own[0].rgb = own[1].rgb = *label.rgb;
    }
    return colored;
}

std::vector<LabelLook> looksOf(const TransferFunction& function) {
    std::vector<LabelLook> looks;
    // Each label has a colour at either end.
    for (std::size_t i = 0; i + 1 < function.colors.size(); i += 2) {
        const double label = 0.5 * (function.colors[i].x + function.colors[i + 1].x);
        looks.push_back({int(label), function.colors[i].rgb, function.opacityAt(label)});
    }
    return looks;
}

}  // namespace deltasplat
