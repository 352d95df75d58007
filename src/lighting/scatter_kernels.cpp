// SPDX-License-Identifier: Apache-2.0
// Based on: L. G. Henyey, J. L. Greenstein, Diffuse Radiation in the Galaxy, 1941, and M.
// Wrenninge, C. Kulla, V. Lundqvist, Oz: The Great and Volumetric, 2013, for octaves. Compiled once
// per SIMD level. The order of additions is fixed, so all levels give the same bits.
#include "lighting/scatter_kernels.h"

#include "base/portable_math.h"
#include "base/simd_targets.h"
#include "lighting/sweep_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lighting/scatter_kernels.cpp"
#include "hwy/foreach_target.h"
// Highway requires this after foreach_target.h.
#include "hwy/highway.h"
#include "lighting/lit_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Share of light left in the least dimmed octave.
HWY_INLINE Vector leftOf(const std::uint16_t* depths, double perStep) {
    const FullTag tag;
    const hn::RebindToSigned<FullTag> whole;
    const hn::Rebind<std::uint16_t, FullTag> narrow;
    const auto root = hn::ConvertTo(tag, hn::PromoteTo(whole, hn::LoadU(narrow, depths)));
    const auto log = hn::Mul(hn::Mul(root, root), constant(perStep));
    return hn::Sub(constant(1), opacityOfLog(log));
}

HWY_INLINE Vector phaseAt(const ScatterPhase& phase, Vector cosine) {
    auto sum = constant(0);
    for (const ScatterPhase::Lobe& lobe : phase.lobes) {
        const auto rest = hn::Sub(constant(lobe.a), hn::Mul(constant(lobe.b), cosine));
        const auto root = hn::Sqrt(rest);
        sum = hn::Add(sum, hn::Div(constant(lobe.k), hn::Mul(rest, root)));
    }
    return sum;
}

// Share of light left at the visible depth of voxels, in the least dimmed octave.
HWY_INLINE Vector ownLeft(const Vector (&own)[4], Vector cosine, int octaves) {
    const auto end = hn::IfThenElse(hn::Lt(cosine, constant(0)), own[0], own[2]);
    auto left = hn::Add(own[1], hn::Mul(hn::Abs(cosine), hn::Sub(end, own[1])));
    for (int i = 0; i < octaves; ++i) left = hn::Sqrt(left);
    return left;
}

// Share of the incoming light that voxels send on: colour times albedo, at most 1.
HWY_INLINE Vector3 sentOnBy(const ScatterWord& word, int n) {
    Vector share[4];
    loadColors(word.sentOn, word.classes + n, share);
    const auto channel = [&](std::size_t c) {
        auto all = share[c];
        if (word.factors) all = hn::Mul(all, hn::LoadU(FullTag(), (*word.factors)[c].data() + n));
        return hn::Min(all, constant(1));
    };
    return {channel(0), channel(1), channel(2)};
}

// The sum over octaves of share(octave) left 2^octave sentOn^octave, by Horner's rule from the
// last, least dimmed octave. Each octave has twice the extinction of the next.
template <typename Share>
HWY_INLINE Vector3 sumOfOctaves(int octaves, Vector left, const Vector3& sentOn,
                                const Share& share) {
    Vector3 all = share(octaves, left);
    for (int octave = octaves - 1; octave >= 0; --octave) {
        left = hn::Mul(left, left);
        all = sum(product(all, sentOn), share(octave, left));
    }
    return all;
}

// Light from a point on a vector of voxels.
struct LitFromPoint {
    Vector share;    // of the light's colour
    Vector cosine;   // of the deflection
    Vector oneSide;  // share of light from one side, not from all sides
};

HWY_INLINE LitFromPoint litFrom(const WaysToEye& toLight, int n, const Vector3& toCamera) {
    const auto way = wholeWaysFrom(toLight, n);
    const auto length = hn::Sqrt(dot(way, way));
    const auto reach = hn::Max(length, constant(1));
    const auto back = hn::Div(dot(way, toCamera), hn::Max(length, constant(1e-30)));
    return {hn::Div(constant(1), hn::Mul(reach, reach)), hn::Neg(back),
            hn::Min(length, constant(1))};
}

HWY_INLINE Vector3 scatteredFromPoint(const ScatterSums& sums, const ScatterRay& ray,
                                      const LitFromPoint& lit, const Vector (&own)[4],
                                      const Vector3& sentOn, Vector left) {
    const int octaves = int(sums.phases.size()) - 1;
    left = hn::Mul(left, ownLeft(own, hn::Mul(lit.oneSide, lit.cosine), octaves));
    const auto share = [&](int octave, Vector leftOfIt) {
        const auto even = constant(0.25 / double(1 << octave));
        const auto straight = phaseAt(sums.phases[std::size_t(octave)], lit.cosine);
        const auto turned = hn::Add(even, hn::Mul(lit.oneSide, hn::Sub(straight, even)));
        return same(hn::Mul(turned, leftOfIt));
    };
    const Vector3 all = sumOfOctaves(octaves, left, sentOn, share);
    return product(vectorOf(ray.color), scaled(all, lit.share));
}

template <bool kFromEye>
void scatterFrom(const ScatterSums& sums, const ScatterWord& word, WordUnits& units) {
    const FullTag tag;
    constexpr int kLanes = int(hn::MaxLanes(FullTag()));
    const int octaves = int(sums.phases.size()) - 1;
    constexpr double kLog2E = 1.4426950408889634;
    const double perStep =
        -kLog2E / (double(kDepthSteps) * double(kDepthSteps)) / double(1 << octaves);
    for (int n = 0; n < 64; n += kLanes) {
        Vector own[4];
        loadColors(word.own, word.classes + n, own);
        const Vector3 sentOn = octaves > 0 ? sentOnBy(word, n) : same(constant(1));
        Vector3 light = vectorOf(sums.ambient);
        Vector3 toCamera = vectorOf(sums.toCamera);
        if (kFromEye) toCamera = waysFrom(*word.ways, n);
        const WaysToEye* toLight = word.toLights;
        for (std::size_t i = 0; i < sums.rays.size(); ++i) {
            const ScatterRay& ray = sums.rays[i];
            auto left = leftOf(word.depths + 64 * i + n, perStep);
            if (ray.isPoint) {
                const LitFromPoint lit = litFrom(*toLight++, n, toCamera);
                light = sum(light, scatteredFromPoint(sums, ray, lit, own, sentOn, left));
                continue;
            }
            auto cosine = hn::Set(tag, ray.cosine);
            if (kFromEye) cosine = dot(vectorOf(ray.way), toCamera);
            left = hn::Mul(left, ownLeft(own, cosine, octaves));
            if (kFromEye) {
                const auto share = [&](int octave, Vector leftOfIt) {
                    const auto turned = phaseAt(sums.phases[std::size_t(octave)], cosine);
                    return same(hn::Mul(turned, leftOfIt));
                };
                const Vector3 all = sumOfOctaves(octaves, left, sentOn, share);
                light = sum(light, product(vectorOf(ray.color), all));
            } else {
                const auto share = [&](int octave, Vector leftOfIt) {
                    return scaled(vectorOf(ray.towardsCamera[std::size_t(octave)]), leftOfIt);
                };
                light = sum(light, sumOfOctaves(octaves, left, sentOn, share));
            }
        }
        Vector rgba[4];
        loadColors(word.colors, word.classes + n, rgba);
        const auto place = [&](std::size_t channel) { return &units[channel][std::size_t(n)]; };
        hn::StoreU(hn::Mul(rgba[0], light.x), tag, place(0));
        hn::StoreU(hn::Mul(rgba[1], light.y), tag, place(1));
        hn::StoreU(hn::Mul(rgba[2], light.z), tag, place(2));
        hn::StoreU(rgba[3], tag, place(3));
    }
}

void scatterKernel(const ScatterSums& sums, const ScatterWord& word, WordUnits& units) {
    if (word.ways) {
        scatterFrom<true>(sums, word, units);
    } else {
        scatterFrom<false>(sums, word, units);
    }
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(scatterKernel);

double ScatterPhase::at(double cosine) const {
    double sum = 0;
    for (const Lobe& lobe : lobes) sum += lobe.at(cosine);
    return sum;
}

// Each lobe is largest straight ahead or straight back, and smallest the other way.
double ScatterPhase::largest() const {
    double sum = 0;
    for (const Lobe& lobe : lobes) sum += lobe.at(lobe.b > 0 ? 1 : -1);
    return sum;
}

double ScatterPhase::smallest() const {
    double sum = 0;
    for (const Lobe& lobe : lobes) sum += lobe.at(lobe.b > 0 ? -1 : 1);
    return sum;
}

glm::vec4 ownLight(double depth) {
    if (depth < 1e-6) return glm::vec4(1);
    if (depth > 1e6) return {0.5, 0, 0, 0};
    const double left = portable::exp(-depth);
    const double taken = -portable::expm1(-depth);
    return {0.5 * (1 + left), taken / depth, depth * left / taken, 0};
}

std::vector<ScatterPhase> phasesOf(const Scattering& scattering) {
    std::vector<ScatterPhase> phases;
    double part = 1;
    for (int octave = 0; octave <= scattering.octaves; ++octave, part /= 2) {
        // pi / (4 pi)
        const auto lobeOf = [&](double g, double share) {
            return ScatterPhase::Lobe{float(0.25 * part * share * (1 - g * g)), float(1 + g * g),
                                      float(2 * g)};
        };
        phases.push_back({{lobeOf(part * scattering.anisotropy, 1 - scattering.backShare),
                           lobeOf(part * scattering.backAnisotropy, scattering.backShare)}});
    }
    return phases;
}

void scatter(const ScatterSums& sums, const ScatterWord& word, WordUnits& units) {
    HWY_DYNAMIC_DISPATCH(scatterKernel)(sums, word, units);
}

}  // namespace deltasplat
#endif
