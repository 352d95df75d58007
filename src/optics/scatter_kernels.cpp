// SPDX-License-Identifier: Apache-2.0
// Based on: L. G. Henyey, J. L. Greenstein, Diffuse Radiation in the Galaxy, 1941, and M.
// Wrenninge, C. Kulla, V. Lundqvist, Oz: The Great and Volumetric, 2013, for octaves. The lighting
// of voxels, compiled once for each SIMD level. Every voxel is reckoned by itself, in one order of
// additions, so that every level gives the same bits.
#include "optics/scatter_kernels.h"

#include "light/sweep_kernels.h"
#include "portable_math.h"
#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optics/scatter_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "optics/lit_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The share of light that is left, of the octave that is dimmed least.
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

// The share of light that is left in voxels where the camera sees them, of the octave that is
// dimmed least.
HWY_INLINE Vector ownLeft(const Vector (&own)[4], Vector cosine, int octaves) {
    const auto end = hn::IfThenElse(hn::Lt(cosine, constant(0)), own[0], own[2]);
    auto left = hn::Add(own[1], hn::Mul(hn::Abs(cosine), hn::Sub(end, own[1])));
    for (int i = 0; i < octaves; ++i) left = hn::Sqrt(left);
    return left;
}

// How a vector of voxels is lit from a point.
struct LitFromPoint {
    Vector share;    // of the light's colour
    Vector cosine;   // between the way of light and that to the camera
    Vector oneSide;  // the share of it that comes from one side, not from all
};

HWY_INLINE LitFromPoint litFrom(const WaysToEye& toLight, int n, const Vector3& toCamera) {
    const auto way = wholeWaysFrom(toLight, n);
    const auto length = hn::Sqrt(dot(way, way));
    const auto reach = hn::Max(length, constant(1));
    const auto back = hn::Div(dot(way, toCamera), hn::Max(length, constant(1e-30)));
    return {hn::Div(constant(1), hn::Mul(reach, reach)), hn::Neg(back),
            hn::Min(length, constant(1))};
}

// What voxels scatter that a point lights.
HWY_INLINE Vector3 scatteredFromPoint(const ScatterSums& sums, const ScatterRay& ray,
                                      const LitFromPoint& lit, const Vector (&own)[4],
                                      Vector left) {
    const int octaves = int(sums.phases.size()) - 1;
    left = hn::Mul(left, ownLeft(own, hn::Mul(lit.oneSide, lit.cosine), octaves));
    auto all = constant(0);
    for (int octave = octaves; octave >= 0; --octave, left = hn::Mul(left, left)) {
        const auto even = constant(0.25 / double(1 << octave));
        const auto straight = phaseAt(sums.phases[std::size_t(octave)], lit.cosine);
        const auto share = hn::Add(even, hn::Mul(lit.oneSide, hn::Sub(straight, even)));
        all = hn::Add(all, hn::Mul(share, left));
    }
    return scaled(vectorOf(ray.color), hn::Mul(lit.share, all));
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
        Vector3 light = vectorOf(sums.ambient);
        Vector3 toCamera = vectorOf(sums.toCamera);
        if (kFromEye) toCamera = waysFrom(*word.ways, n);
        const WaysToEye* toLight = word.toLights;
        for (std::size_t i = 0; i < sums.rays.size(); ++i) {
            const ScatterRay& ray = sums.rays[i];
            auto left = leftOf(word.depths + 64 * i + n, perStep);
            if (ray.isPoint) {
                const LitFromPoint lit = litFrom(*toLight++, n, toCamera);
                light = sum(light, scatteredFromPoint(sums, ray, lit, own, left));
                continue;
            }
            auto cosine = hn::Set(tag, ray.cosine);
            if (kFromEye) cosine = dot(vectorOf(ray.way), toCamera);
            left = hn::Mul(left, ownLeft(own, cosine, octaves));
            // Each octave has twice the extinction of the next.
            for (int octave = octaves; octave >= 0; --octave, left = hn::Mul(left, left)) {
                if (kFromEye) {
                    const auto share = phaseAt(sums.phases[std::size_t(octave)], cosine);
                    light = sum(light, scaled(vectorOf(ray.color), hn::Mul(share, left)));
                } else {
                    light =
                        sum(light, scaled(vectorOf(ray.towardsCamera[std::size_t(octave)]), left));
                }
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

// Each lobe is largest straight ahead, or straight back, and smallest the other way.
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
