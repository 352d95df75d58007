// SPDX-License-Identifier: Apache-2.0
#include "base/opacity_steps.h"

#include <algorithm>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "base/opacity_steps.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "base/opacity_steps-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {

void repeatOpacityKernel(float* opacities, const float* steps, std::size_t count) {
    const FullTag tag;
    for (std::size_t i = 0; i < count; i += hn::Lanes(tag)) {
        const std::size_t left = std::min(hn::Lanes(tag), count - i);
        HWY_ALIGN float rest[hn::MaxLanes(FullTag())] = {};
        std::copy_n(opacities + i, left, rest);
        const auto repeated = opacityOfSteps(hn::Load(tag, rest), hn::LoadU(tag, steps + i));
        hn::Store(repeated, tag, rest);
        std::copy_n(rest, left, opacities + i);
    }
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(repeatOpacityKernel);

void repeatOpacity(float* opacities, const float* steps, std::size_t count) {
    HWY_DYNAMIC_DISPATCH(repeatOpacityKernel)(opacities, steps, count);
}

}  // namespace deltasplat
#endif
