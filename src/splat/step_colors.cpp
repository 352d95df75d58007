// SPDX-License-Identifier: Apache-2.0
#include "splat/step_colors.h"

#include <utility>

namespace deltasplat {

StepColors::StepColors(const PackedDeltas& deltas, ClassTable classes, const LookLight* light,
                       std::pmr::memory_resource& memory)
    : classes_(std::move(classes)) {
    if (light) {
        own_.emplace(deltas, *light, memory);
    } else if (!classes_.oneDigit()) {
        digitVoxels_.emplace(deltas, classes_);
    }
}

}  // namespace deltasplat
