// SPDX-License-Identifier: Apache-2.0
#include "splat/step_colors.h"

#include <utility>

namespace deltasplat {

StepColors::StepColors(const PackedDeltas& deltas, ClassTable classes,
                       std::unique_ptr<const LookLight> light)
    : classes_(std::move(classes)) {
    if (light) own_.emplace(deltas, classes_, std::move(light));
}

}  // namespace deltasplat
