// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "deltasplat/synth/write_analytic.h"

namespace deltasplat {

/// Returns the mean of a voxel's samples.
/// @param valueAt  gives a number or a vector for a position
template <typename ValueAt>
auto sampleVoxel(const ValueAt& valueAt, const glm::ivec3& index,
                 const AnalyticFileOptions& options) {
    const int each = options.samples;
    decltype(valueAt(glm::dvec3())) sum(0);
    for (int n = 0; n < each * each * each; ++n) {
        const glm::dvec3 part(n % each, n / each % each, n / (each * each));
        const glm::dvec3 at = 2.0 * glm::dvec3(index) + (2.0 * part + 1.0) / double(each);
        sum += valueAt(at / glm::dvec3(options.dims) - 1.0);
    }
    return sum / double(each * each * each);
}

}  // namespace deltasplat
