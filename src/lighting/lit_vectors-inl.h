// SPDX-License-Identifier: Apache-2.0
// Vectors of lit voxels for the kernels of each SIMD level, with the same bits at all levels.
#if defined(DELTASPLAT_LIT_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DELTASPLAT_LIT_VECTORS_INL_H_
#undef DELTASPLAT_LIT_VECTORS_INL_H_
#else
#define DELTASPLAT_LIT_VECTORS_INL_H_
#endif

#include "base/opacity_steps-inl.h"
#include "hwy/highway.h"
#include "lighting/ways_to_eye.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct Vector3 {
    Vector x, y, z;
};

HWY_INLINE Vector3 vectorOf(const glm::vec3& v) {
    const FullTag tag;
    return {hn::Set(tag, v.x), hn::Set(tag, v.y), hn::Set(tag, v.z)};
}

HWY_INLINE Vector dot(const Vector3& a, const Vector3& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

HWY_INLINE Vector3 same(Vector a) {
    return {a, a, a};
}

HWY_INLINE Vector3 product(const Vector3& a, const Vector3& b) {
    return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}

HWY_INLINE Vector3 scaled(const Vector3& a, Vector share) {
    return {hn::Mul(a.x, share), hn::Mul(a.y, share), hn::Mul(a.z, share)};
}

HWY_INLINE Vector3 sum(const Vector3& a, const Vector3& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

// Scales to length 1; a zero vector stays 0.
HWY_INLINE Vector3 normalized(const Vector3& a) {
    const auto length = hn::Sqrt(dot(a, a));
    return scaled(a, hn::Div(constant(1), hn::Max(length, constant(1e-30))));
}

// The ways of a vector of voxels from voxel n on, at full length.
HWY_INLINE Vector3 wholeWaysFrom(const WaysToEye& ways, int n) {
    const FullTag tag;
    const hn::RebindToSigned<FullTag> whole;
    const auto number = hn::Add(hn::Iota(whole, 0), hn::Set(whole, n));
    const auto u = hn::ConvertTo(tag, hn::ShiftRight<3>(number));
    const auto v = hn::ConvertTo(tag, hn::And(number, hn::Set(whole, 7)));
    return sum(vectorOf(ways.first),
               sum(scaled(vectorOf(ways.alongU), u), scaled(vectorOf(ways.alongV), v)));
}

// The ways at length 1.
HWY_INLINE Vector3 waysFrom(const WaysToEye& ways, int n) {
    return normalized(wholeWaysFrom(ways, n));
}

// The premultiplied class colours of a vector of voxels.
HWY_INLINE void loadColors(const glm::vec4* colors, const std::uint16_t* classes,
                           Vector (&rgba)[4]) {
    const FullTag tag;
    const hn::RebindToSigned<FullTag> whole;
    const hn::Rebind<std::uint16_t, FullTag> narrow;
    const auto first = hn::ShiftLeft<2>(hn::PromoteTo(whole, hn::LoadU(narrow, classes)));
    const float* channels = &colors->x;
    for (int c = 0; c < 4; ++c) rgba[c] = hn::GatherIndex(tag, channels + c, first);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
