// SPDX-License-Identifier: Apache-2.0
#include "optics/label_function.h"

namespace deltasplat {

TransferFunction labelFunction(const std::vector<LabelLook>& looks) {
    TransferFunction function;
    // Of several points at the same place the last one counts.
    function.opacities = {{looks.front().label - 0.5, 0, 0.5, 0}};
    for (const LabelLook& look : looks) {
        const double begin = look.label - 0.5;
        const double end = look.label + 0.5;
        if (function.opacities.back().x < begin) function.opacities.push_back({begin, 0, 0.5, 0});
        for (const double x : {begin, end}) {
            function.colors.push_back({x, look.rgb});
            function.opacities.push_back({x, look.opacity, 0.5, 0});
        }
        function.opacities.push_back({end, 0, 0.5, 0});
    }
    return function;
}

}  // namespace deltasplat
