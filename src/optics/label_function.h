// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "deltasplat/ingest/label_list.h"
#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// What the voxels of a label look like.
struct LabelLook {
    int label = 0;
    glm::dvec3 rgb{0.0};  ///< sRGB, 0..1
    double opacity = 0;   ///< 0..1, over one unit distance
};

/// Returns the transfer function of data values that are labels: each has its own look half way to
/// its neighbours, all others are clear. It is categorical.
/// @param looks  at least one, labels rising
TransferFunction labelFunction(const std::vector<LabelLook>& looks);

/// Returns such a function with the colours that a file gives labels, of those that both have.
TransferFunction withColors(const TransferFunction& function, const LabelList& labels);

/// Returns the looks of which labelFunction made a function.
std::vector<LabelLook> looksOf(const TransferFunction& function);

}  // namespace deltasplat
