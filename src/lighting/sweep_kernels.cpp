// SPDX-License-Identifier: Apache-2.0
// Compiled once per SIMD level. Operations have a fixed order, so all levels give the same bits.
#include "lighting/sweep_kernels.h"

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lighting/sweep_kernels.cpp"
#include "hwy/foreach_target.h"
// Highway requires this after foreach_target.h.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using RowTag = hn::CappedTag<float, 8>;
using Part = hn::Vec<RowTag>;

HWY_INLINE Part between(Part a, Part b, float share) {
    return hn::Add(a, hn::Mul(hn::Set(RowTag(), share), hn::Sub(b, a)));
}

bool lookUpMetKernel(const MetClasses& met, const std::uint16_t* classes, float* own) {
    const RowTag tag;
    const hn::RebindToSigned<RowTag> whole;
    const hn::Rebind<std::uint16_t, RowTag> narrow;
    auto any = hn::Zero(tag);
    for (std::size_t n = 0; n < 64; n += hn::Lanes(tag)) {
        const auto numbers = hn::PromoteTo(whole, hn::LoadU(narrow, classes + n));
        const auto extinction = hn::GatherIndex(tag, met.extinctions, numbers);
        const auto depth =
            hn::Min(hn::Mul(extinction, hn::Set(tag, met.step)), hn::Set(tag, met.most));
        hn::StoreU(depth, tag, own + n);
        any = hn::Max(any, depth);
    }
    return !hn::AllTrue(tag, hn::Eq(any, hn::Zero(tag)));
}

void readSweptKernel(const SweptPlace& place, int end, std::uint16_t* codes) {
    const RowTag tag;
    const hn::RebindToSigned<RowTag> whole;
    const hn::Rebind<std::uint16_t, RowTag> narrow;
    for (int u = place.begin; u < end; ++u) {
        const float* above = place.first + std::size_t(u - place.begin) * place.pitch;
        const float* below = above + place.pitch;
        for (std::size_t v = 0; v < 8; v += hn::Lanes(tag)) {
            const auto inAbove =
                between(hn::LoadU(tag, above + v), hn::LoadU(tag, above + v + 1), place.share.y);
            const auto inBelow =
                between(hn::LoadU(tag, below + v), hn::LoadU(tag, below + v + 1), place.share.y);
            const std::size_t n = 8 * std::size_t(u) + v;
            const auto depth = between(inAbove, inBelow, place.share.x);
            const auto code =
                hn::Add(hn::Mul(hn::Sqrt(depth), hn::Set(tag, kDepthSteps)), hn::Set(tag, 0.5f));
            const auto bounded = hn::ConvertTo(whole, hn::Min(code, hn::Set(tag, 65535.0f)));
            hn::StoreU(hn::DemoteTo(narrow, bounded), narrow, codes + n);
        }
    }
}

void addSweptKernel(const SweptPlace& place, int end, const float* own) {
    const RowTag tag;
    // Rows interpolated at the nine columns of the plane; zeros behind the last.
    HWY_ALIGN float sums[10][16] = {};
    const auto now = hn::Set(tag, 1 - place.share.y);
    const auto next = hn::Set(tag, place.share.y);
    for (int u = 0; u < 8; ++u) {
        // One zero before the first voxel of the row, and one behind the last.
        HWY_ALIGN float row[24] = {};
        for (std::size_t v = 0; v < 8; v += hn::Lanes(tag))
            hn::StoreU(hn::LoadU(tag, own + 8 * u + v), tag, row + 1 + v);
        for (std::size_t v = 0; v < 16; v += hn::Lanes(tag)) {
            hn::StoreU(hn::Add(hn::Mul(now, hn::LoadU(tag, row + 1 + v)),
                               hn::Mul(next, hn::LoadU(tag, row + v))),
                       tag, sums[u + 1] + v);
        }
    }
    const auto here = hn::Set(tag, 1 - place.share.x);
    const auto before = hn::Set(tag, place.share.x);
    for (int k = place.begin; k < end; ++k) {
        float* out = place.first + std::size_t(k - place.begin) * place.pitch;
        for (std::size_t v = 0; v < 8; v += hn::Lanes(tag)) {
            const auto sum = hn::Add(hn::Mul(here, hn::LoadU(tag, sums[k + 1] + v)),
                                     hn::Mul(before, hn::LoadU(tag, sums[k] + v)));
            hn::StoreU(hn::Add(hn::LoadU(tag, out + v), sum), tag, out + v);
        }
        out[8] += (1 - place.share.x) * sums[k + 1][8] + place.share.x * sums[k][8];
    }
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(lookUpMetKernel);
HWY_EXPORT(readSweptKernel);
HWY_EXPORT(addSweptKernel);

bool lookUpMet(const MetClasses& met, const std::uint16_t* classes, float* own) {
    return HWY_DYNAMIC_DISPATCH(lookUpMetKernel)(met, classes, own);
}

void readSwept(const SweptPlace& place, int end, std::uint16_t* codes) {
    HWY_DYNAMIC_DISPATCH(readSweptKernel)(place, end, codes);
}

void addSwept(const SweptPlace& place, int end, const float* own) {
    HWY_DYNAMIC_DISPATCH(addSweptKernel)(place, end, own);
}

}  // namespace deltasplat
#endif
