// SPDX-License-Identifier: Apache-2.0
#include "splat/step_colors.h"

#include <utility>

namespace deltasplat {

StepColors::StepColors(const PackedDeltas& deltas, ClassTable classes, const VoxelPainter* painter)
    : classes_(std::move(classes)) {
    if (painter) {
        own_.emplace(deltas, classes_, painter->brightest());
    } else if (!classes_.oneDigit()) {
        digitVoxels_.emplace(deltas, classes_);
    }
}

}  // namespace deltasplat
