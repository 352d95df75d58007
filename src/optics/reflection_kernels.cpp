// SPDX-License-Identifier: Apache-2.0
// Based on: J. F. Blinn, Models of Light Reflection for Computer Synthesized Pictures, 1977.
// The lighting of voxels, compiled once for each SIMD level. Every voxel is reckoned by itself, in
// one order of additions, so that every level gives the same bits.
#include "optics/reflection_kernels.h"

#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optics/reflection_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "optics/lit_vectors-inl.h"
#include "optics/opacity_steps-inl.h"

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

// Of the two sides of a gradient the one that faces the camera.
HWY_INLINE Vector3 turnedTo(const Vector3& toCamera, const Vector3& gradient) {
    const auto isTurned = hn::Lt(dot(gradient, toCamera), hn::Zero(FullTag()));
    return {hn::IfThenElse(isTurned, hn::Neg(gradient.x), gradient.x),
            hn::IfThenElse(isTurned, hn::Neg(gradient.y), gradient.y),
            hn::IfThenElse(isTurned, hn::Neg(gradient.z), gradient.z)};
}

// Voxels beyond an outline show through those that it cuts, and are lit as it is: across the line
// of sight, as near to their own gradient as that can be.
HWY_INLINE Vector3 outlinedTo(const Vector3& toCamera, const Vector3& gradient, Vector length) {
    const auto away = hn::Min(dot(gradient, toCamera), hn::Zero(FullTag()));
    const Vector3 across = sum(gradient, scaled(toCamera, hn::Neg(away)));
    const auto left = hn::Max(hn::Sqrt(dot(across, across)), constant(1e-5));
    const auto isBeyond = hn::Lt(away, hn::Zero(FullTag()));
    const auto ratio = hn::IfThenElse(isBeyond, hn::Div(length, left), constant(1));
    return scaled(across, ratio);
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
        const Vector3 normal = reflection.isSolid ? outlinedTo(toCamera, gradient, shaded)
                                                  : turnedTo(toCamera, gradient);
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
