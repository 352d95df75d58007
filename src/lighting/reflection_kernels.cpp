// SPDX-License-Identifier: Apache-2.0
// Based on: J. F. Blinn, Models of Light Reflection for Computer Synthesized Pictures, 1977.
// Compiled once per SIMD level. The order of additions is fixed, so all levels give the same bits.
#include "lighting/reflection_kernels.h"

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lighting/reflection_kernels.cpp"
#include "hwy/foreach_target.h"
// Highway requires this after foreach_target.h.
#include "base/opacity_steps-inl.h"
#include "hwy/highway.h"
#include "lighting/lit_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// x^y for 0 <= x <= 1.
HWY_INLINE Vector power(Vector x, Vector y) {
    return hn::Sub(constant(1), opacityOfSteps(hn::Sub(constant(1), x), y));
}

// The gradients of a vector of voxels, times kMostSlope.
HWY_INLINE Vector3 gradientsOf(const OwnLook* looks) {
    const FullTag tag;
    const hn::RebindToSigned<FullTag> whole;
    hn::Vec<decltype(whole)> low, high;
    hn::LoadInterleaved2(whole, reinterpret_cast<const std::int32_t*>(looks), low, high);
    return {hn::ConvertTo(tag, hn::ShiftRight<16>(hn::ShiftLeft<16>(low))),
            hn::ConvertTo(tag, hn::ShiftRight<16>(low)),
            hn::ConvertTo(tag, hn::ShiftRight<16>(hn::ShiftLeft<16>(high)))};
}

// Flips gradients that point away from the camera.
HWY_INLINE Vector3 turnedTo(const Vector3& toCamera, const Vector3& gradient) {
    const auto isTurned = hn::Lt(dot(gradient, toCamera), hn::Zero(FullTag()));
    return {hn::IfThenElse(isTurned, hn::Neg(gradient.x), gradient.x),
            hn::IfThenElse(isTurned, hn::Neg(gradient.y), gradient.y),
            hn::IfThenElse(isTurned, hn::Neg(gradient.z), gradient.z)};
}

HWY_INLINE Vector heightsOf(const OwnLook* looks) {
    const FullTag tag;
    const hn::RebindToSigned<FullTag> whole;
    hn::Vec<decltype(whole)> low, high;
    hn::LoadInterleaved2(whole, reinterpret_cast<const std::int32_t*>(looks), low, high);
    return hn::ConvertTo(tag, hn::And(hn::ShiftRight<16>(high), hn::Set(whole, 0xFF)));
}

// Opacities of voxels at a surface. Down to depth d, in voxel sizes, a share of 1 / (1 + e^(k d))
// comes through on any way. A voxel lets through the ratio of the shares behind and before its
// step, so a line of sight along a surface becomes as opaque in many steps as in one, and on its
// way out no more.
HWY_INLINE Vector opacitiesOf(const CutVoxels& cut, const Vector3& normal, const Vector3& toCamera,
                              Vector height) {
    // Same deviation as a box of the voxel's size.
    constexpr double kSteepness = 6.3;
    // Blurred slices cover more, by this much per variance of depths.
    constexpr double kPerVariance = 0.75;
    constexpr double kLog2OfE = 1.44269504;
    const auto alongSlice = dot(normal, vectorOf(cut.steps[0]));
    const auto alongU = dot(normal, vectorOf(cut.steps[1]));
    const auto alongV = dot(normal, vectorOf(cut.steps[2]));
    const auto uu = hn::Mul(alongU, alongU);
    const auto vv = hn::Mul(alongV, alongV);
    const auto square = hn::Add(hn::Mul(alongSlice, alongSlice), hn::Add(uu, vv));
    const auto perSquare = hn::Div(constant(1), hn::Max(square, constant(1e-30)));
    const auto blurred =
        hn::Add(hn::Add(hn::Mul(uu, constant(cut.blur.x)), hn::Mul(vv, constant(cut.blur.y))),
                hn::Mul(hn::Mul(alongU, alongV), constant(2 * cut.blur.z)));
    const auto variance = hn::Mul(blurred, perSquare);
    const auto slices = hn::Max(hn::Abs(dot(toCamera, vectorOf(cut.perSlice))), constant(1e-30));
    const auto facing = hn::Max(dot(normal, toCamera), hn::Zero(FullTag()));
    const auto deeper = hn::Mul(hn::Div(facing, slices), hn::Sqrt(perSquare));
    const auto middle =
        hn::Sub(mulAdd(height, constant(-1 / double(kHeightSteps)), constant(kMostDepth)),
                hn::Mul(variance, constant(kPerVariance)));
    const auto behind =
        hn::Mul(constant(kSteepness * kLog2OfE), mulAdd(deeper, constant(0.5), middle));
    const auto some = opacityOfLog(hn::Mul(deeper, constant(-kSteepness * kLog2OfE)));
    // some / (1 + 2^-behind)
    const auto small = hn::Sub(constant(1), opacityOfLog(hn::Neg(hn::Abs(behind))));
    const auto isAbove = hn::Lt(behind, hn::Zero(FullTag()));
    const auto share = hn::IfThenElse(isAbove, small, constant(1));
    return hn::Div(hn::Mul(some, share), hn::Add(constant(1), small));
}

template <bool kFromEye>
void reflectFrom(const Reflection& reflection, const WordToLight& word, WordUnits& units) {
    const FullTag tag;
    constexpr int kLanes = int(hn::MaxLanes(FullTag()));
    const auto zero = hn::Zero(tag);
    for (int n = 0; n < 64; n += kLanes) {
        const auto toCamera = kFromEye ? waysFrom(*word.ways, n) : vectorOf(reflection.toCamera);
        const auto gradient = scaled(gradientsOf(word.looks + n), constant(1 / double(kMostSlope)));
        const auto shaded = hn::Min(hn::Sqrt(dot(gradient, gradient)), constant(1));
        const auto unshaded = hn::Mul(constant(0.25), hn::Sub(constant(1), shaded));
        const auto perShaded = hn::Div(constant(1), hn::Max(shaded, constant(1e-5)));
        const Vector3 normal = reflection.cut ? gradient : turnedTo(toCamera, gradient);
        Vector3 share = vectorOf(glm::vec3(reflection.ambient));
        Vector3 highlights{zero, zero, zero};
        for (const Ray& ray : reflection.rays) {
            const auto toLight = ray.fromCamera ? toCamera : vectorOf(ray.toLight);
            const auto facing = hn::Max(dot(normal, toLight), zero);
            const auto onAverage =
                hn::Mul(unshaded, hn::Max(hn::Add(constant(1), dot(toLight, toCamera)), zero));
            share = sum(share, scaled(vectorOf(ray.diffuse), hn::Add(facing, onAverage)));
            if (!reflection.hasSpecular) continue;
            const auto half = ray.fromCamera ? toCamera
                              : kFromEye     ? normalized(sum(toLight, toCamera))
                                             : vectorOf(ray.half);
            const auto cosine = hn::Mul(hn::Max(dot(normal, half), zero), perShaded);
            const auto highlight = power(cosine, hn::Set(tag, reflection.shininess));
            const auto isLit = hn::Gt(facing, zero);
            highlights =
                sum(highlights, scaled(vectorOf(ray.specular),
                                       hn::IfThenElseZero(isLit, hn::Mul(shaded, highlight))));
        }
        Vector rgba[4];
        loadColors(word.colors, word.classes + n, rgba);
        if (reflection.cut) {
            const auto height = heightsOf(word.looks + n);
            const auto isDeep = hn::Eq(height, zero);
            const auto opacity = opacitiesOf(*reflection.cut, normal, toCamera, height);
            for (Vector& channel : rgba)
                channel = hn::Mul(channel, hn::IfThenElse(isDeep, constant(1), opacity));
        }
        const auto place = [&](std::size_t channel) { return &units[channel][std::size_t(n)]; };
        hn::StoreU(mulAdd(rgba[0], share.x, hn::Mul(rgba[3], highlights.x)), tag, place(0));
        hn::StoreU(mulAdd(rgba[1], share.y, hn::Mul(rgba[3], highlights.y)), tag, place(1));
        hn::StoreU(mulAdd(rgba[2], share.z, hn::Mul(rgba[3], highlights.z)), tag, place(2));
        hn::StoreU(rgba[3], tag, place(3));
    }
}

void reflectKernel(const Reflection& reflection, const WordToLight& word, WordUnits& units) {
    if (reflection.fromEye) {
        reflectFrom<true>(reflection, word, units);
    } else {
        reflectFrom<false>(reflection, word, units);
    }
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(reflectKernel);

void reflect(const Reflection& reflection, const WordToLight& word, WordUnits& units) {
    HWY_DYNAMIC_DISPATCH(reflectKernel)(reflection, word, units);
}

}  // namespace deltasplat
#endif
