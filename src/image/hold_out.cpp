// SPDX-License-Identifier: Apache-2.0
// Based on: P. Hillman, The Theory of OpenEXR Deep Samples, 2013 (how a volume sample is cut).
#include "deltasplat/hold_out.h"

#include <algorithm>
#include <cmath>
#include <glm/vec4.hpp>

#include "base/default_floats.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/text.h"
#include "deltasplat/error.h"

namespace deltasplat {
namespace {

// What is left of a sample before a depth.
glm::vec4 cutAt(const DeepSample& sample, float depth) {
    if (depth >= sample.zBack) return sample.rgba;
    if (depth <= sample.z) return glm::vec4(0);
    const double share = (double(depth) - sample.z) / (double(sample.zBack) - sample.z);
    const double alpha = sample.rgba.a;
    if (alpha >= 1) return sample.rgba;
    if (alpha <= 0) return sample.rgba * float(share);
    const double left = -portable::expm1(share * portable::log1p(-alpha));
    return sample.rgba * float(left / alpha);
}

}  // namespace

Image holdOut(const DeepImage& deep, const DepthImage& solid) {
    const DefaultFloats floats;
    if (deep.size != solid.size) {
        throw Error(ErrorCode::kUsage, "depths of solid things", dimsText(solid.size) + " pixels",
                    dimsText(deep.size) + ", those of the picture");
    }
    Image image(deep.size);
    parallelFor(std::size_t(deep.size.y), [&](std::size_t y) {
        for (int x = 0; x < deep.size.x; ++x) {
            float* rgba = image.pixel(x, int(y));
            const float depth = solid.depths[y * std::size_t(deep.size.x) + std::size_t(x)];
            for (const DeepSample& sample : deep.pixel(x, int(y))) {
                if (sample.z >= depth) break;
                const glm::vec4 seen = cutAt(sample, depth);
                const float clear = 1 - rgba[3];
                for (int c = 0; c < 4; ++c) rgba[c] += clear * seen[c];
            }
        }
    });
    return image;
}

}  // namespace deltasplat
