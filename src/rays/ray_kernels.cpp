// SPDX-License-Identifier: Apache-2.0
// The inner loops of line integrals and maxima, compiled once per SIMD level.
// Based on: W. Kahan, "Further remarks on reducing truncation errors", 1965 (sums of many slices);
// the integrals of trilinear interpolation are our own (docs/method.md).
#include "rays/ray_kernels.h"

#include <limits>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rays/ray_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using EightTag = hn::CappedTag<float, 8>;

using IntTag = hn::RebindToSigned<EightTag>;

// Four rows of four neighbouring values for a vector of rays; each holds one value per ray.
template <class V>
struct Fours {
    V at[4];
};

// Loads four values of a ray, and of the ray four further.
template <class Tag>
HWY_INLINE hn::Vec<Tag> loadRay(Tag tag, const float* values, const std::int32_t* offsets) {
    const hn::CappedTag<float, 4> quarter;
    const auto low = hn::LoadU(quarter, values + offsets[0]);
    if constexpr (hn::MaxLanes(Tag()) == 8) {
        return hn::Combine(tag, hn::LoadU(quarter, values + offsets[4]), low);
    } else {
        return low;
    }
}

// Loads four values per ray, as rows of a transposed matrix.
HWY_INLINE Fours<hn::Vec<EightTag>> loadFours(const float* values, const std::int32_t* offsets) {
    const EightTag tag;
    const auto load = [&](int ray) { return loadRay(tag, values, offsets + ray); };
    const hn::RepartitionToWide<EightTag> pairs;
    const auto a = load(0), b = load(1), c = load(2), d = load(3);
    const auto abLow = hn::BitCast(pairs, hn::InterleaveLower(tag, a, b));
    const auto abHigh = hn::BitCast(pairs, hn::InterleaveUpper(tag, a, b));
    const auto cdLow = hn::BitCast(pairs, hn::InterleaveLower(tag, c, d));
    const auto cdHigh = hn::BitCast(pairs, hn::InterleaveUpper(tag, c, d));
    return {{hn::BitCast(tag, hn::InterleaveLower(pairs, abLow, cdLow)),
             hn::BitCast(tag, hn::InterleaveUpper(pairs, abLow, cdLow)),
             hn::BitCast(tag, hn::InterleaveLower(pairs, abHigh, cdHigh)),
             hn::BitCast(tag, hn::InterleaveUpper(pairs, abHigh, cdHigh))}};
}

// Position between two voxels along an axis, and progress per slice.
template <class V>
struct Along {
    V first;    // 0 <= first < 1: distance behind the first read voxel
    V slope;    // 0 <= slope <= 1
    V inverse;  // 1 / slope, or 0
};

// For a ray from the slice before a slice to the one behind, r = 0 to 2, that crosses a plane of
// voxels at p: the remaining way, and integrals over the slice's tent from p on, times (r - p), and
// times (r - p) and the remaining way.
template <class V>
struct Crossing {
    V left;
    V plain;
    V weighed;
};

template <class V>
HWY_INLINE Crossing<V> crossingAt(V left) {
    const EightTag tag;
    const auto two = hn::Set(tag, 2.0f);
    const auto third = hn::Set(tag, 1.0f / 3);
    const auto z = hn::Min(hn::Max(left, hn::Zero(tag)), two);
    const auto h = hn::Max(hn::Sub(z, hn::Set(tag, 1.0f)), hn::Zero(tag));
    const auto z3 = hn::Mul(hn::Mul(z, z), z);
    const auto h3 = hn::Mul(hn::Mul(h, h), h);
    const auto plain = hn::Sub(hn::Mul(z3, hn::Set(tag, 1.0f / 6)), hn::Mul(h3, third));
    const auto fourths = hn::Sub(hn::Mul(z3, z), hn::Mul(two, hn::Mul(h3, h)));
    const auto weighed = hn::Sub(hn::Mul(fourths, hn::Set(tag, 1.0f / 12)), hn::Mul(h3, third));
    return {z, plain, weighed};
}

// Integral over the slice's tent of (r - p) (r - q), from the later of p and q on.
template <class V>
HWY_INLINE V bothCrossings(V z, V w) {
    const EightTag tag;
    const auto one = hn::Set(tag, 1.0f);
    const auto less = hn::Min(z, w);
    const auto twice = hn::Sub(hn::Mul(hn::Set(tag, 2.0f), hn::Max(z, w)), less);
    const auto h = hn::Max(hn::Sub(less, one), hn::Zero(tag));
    const auto whole = hn::Mul(hn::Mul(hn::Mul(less, less), less), twice);
    const auto past = hn::Mul(hn::Mul(hn::Mul(h, h), h), hn::Sub(twice, one));
    return hn::Mul(hn::Sub(whole, hn::Mul(hn::Set(tag, 2.0f), past)), hn::Set(tag, 1.0f / 12));
}

// Linear interpolation of four voxels is g0 + (g1 - g0) X + d2 (X - 1)+ + d3 (X - 2)+ with second
// differences d2 and d3. Computes these four from the first kCount voxels.
template <int kCount, class V>
HWY_INLINE void takeDifferences(V* g) {
    if constexpr (kCount == 4) g[3] = hn::Sub(hn::Sub(g[3], g[2]), hn::Sub(g[2], g[1]));
    if constexpr (kCount >= 3) g[2] = hn::Sub(hn::Sub(g[2], g[1]), hn::Sub(g[1], g[0]));
    g[1] = hn::Sub(g[1], g[0]);
}

// Integrals over a slice's tent of the products of takeDifferences() terms for u and v.
template <int kU, int kV, class V>
HWY_INLINE void takeMoments(const Along<V>& u, const Along<V>& v, V (*m)[4]) {
    const EightTag tag;
    const auto two = hn::Set(tag, 2.0f);
    const auto middleU = hn::Add(u.first, u.slope);
    const auto middleV = hn::Add(v.first, v.slope);
    m[0][0] = hn::Set(tag, 1.0f);
    m[1][0] = middleU;
    m[0][1] = middleV;
    m[1][1] = hn::Add(hn::Mul(middleU, middleV),
                      hn::Mul(hn::Mul(u.slope, v.slope), hn::Set(tag, 1.0f / 6)));
    const auto cross = [&](const Along<V>& along, int node) {
        const auto end = hn::Add(along.first, hn::Mul(two, along.slope));
        return crossingAt(hn::Mul(hn::Sub(end, hn::Set(tag, float(node))), along.inverse));
    };
    const Crossing<V> crossU[2] = {cross(u, 1), cross(u, 2)};
    const Crossing<V> crossV[2] = {cross(v, 1), cross(v, 2)};
    for (int i = 0; i < kU - 2; ++i) {
        m[2 + i][0] = hn::Mul(u.slope, crossU[i].plain);
        const auto end = hn::Add(v.first, hn::Mul(two, v.slope));
        m[2 + i][1] = hn::Mul(
            u.slope, hn::Sub(hn::Mul(end, crossU[i].plain), hn::Mul(v.slope, crossU[i].weighed)));
    }
    for (int j = 0; j < kV - 2; ++j) {
        m[0][2 + j] = hn::Mul(v.slope, crossV[j].plain);
        const auto end = hn::Add(u.first, hn::Mul(two, u.slope));
        m[1][2 + j] = hn::Mul(
            v.slope, hn::Sub(hn::Mul(end, crossV[j].plain), hn::Mul(u.slope, crossV[j].weighed)));
    }
    const auto both = hn::Mul(u.slope, v.slope);
    for (int i = 0; i < kU - 2; ++i) {
        for (int j = 0; j < kV - 2; ++j)
            m[2 + i][2 + j] = hn::Mul(both, bothCrossings(crossU[i].left, crossV[j].left));
    }
}

constexpr int kTopShift = 2;
static_assert(1 << kTopShift == kTopCell);

// Where rays read a patch, and the first value of each ray.
template <class V>
struct Reading {
    V u, v;  // 0 <= u, v < 1: distance behind the first read voxel
    HWY_ALIGN std::int32_t offsets[8];
    HWY_ALIGN std::int32_t tops[8];  // places in the patch's tops
};

// Reading at a distance in slices behind the first.
template <class V>
HWY_INLINE Reading<V> readingAt(const RayPatch& patch, const RayRun& rays, std::size_t i, V slices,
                                V slopeU, V slopeV) {
    const EightTag tag;
    const IntTag ints;
    const auto u = hn::Add(hn::LoadU(tag, rays.u + i), hn::Mul(slices, slopeU));
    const auto v = hn::Add(hn::LoadU(tag, rays.v + i), hn::Mul(slices, slopeV));
    const auto floorU = hn::Floor(u);
    const auto floorV = hn::Floor(v);
    // Nothing is outside of the patch, nor at its border.
    const auto place = [&](V behind, const std::int32_t* whole, int size) {
        const auto at = hn::Add(hn::LoadU(ints, whole + i), hn::ConvertTo(ints, behind));
        return hn::Min(hn::Max(at, hn::Zero(ints)), hn::Set(ints, size - 4));
    };
    const auto wholeU = place(floorU, rays.wholeU, patch.sizeU);
    const auto wholeV = place(floorV, rays.wholeV, patch.sizeV);
    Reading<V> reading{hn::Sub(u, floorU), hn::Sub(v, floorV), {}, {}};
    const auto row = hn::Mul(wholeU, hn::Set(ints, patch.sizeV));
    hn::Store(hn::Add(row, wholeV), ints, reading.offsets);
    if (patch.tops) {
        const auto cells = hn::Mul(hn::ShiftRight<kTopShift>(wholeU), hn::Set(ints, patch.topsV));
        hn::Store(hn::Add(cells, hn::ShiftRight<kTopShift>(wholeV)), ints, reading.tops);
    }
    return reading;
}

// A sum and its rounding error, which the next addition subtracts.
template <class V>
struct Sum {
    V sum, rest;

    HWY_INLINE void add(V value) {
        const auto more = hn::Sub(value, rest);
        const auto next = hn::Add(sum, more);
        rest = hn::Sub(hn::Sub(next, sum), more);
        sum = next;
    }
};

// Integral of a slice along rays, from its moments.
template <int kU, int kV, class V>
HWY_INLINE V integral(const float* values, int sizeV, const std::int32_t* offsets,
                      const V (*m)[4]) {
    V g[4][4];
    for (int row = 0; row < kU; ++row) {
        const Fours<V> fours = loadFours(values + row * std::ptrdiff_t{sizeV}, offsets);
        for (int column = 0; column < kV; ++column) g[column][row] = fours.at[column];
    }
    for (int column = 0; column < kV; ++column) takeDifferences<kU>(g[column]);
    auto read = hn::Zero(EightTag());
    for (int row = 0; row < kU; ++row) {
        V along[4];
        for (int column = 0; column < kV; ++column) along[column] = g[column][row];
        takeDifferences<kV>(along);
        for (int column = 0; column < kV; ++column)
            read = hn::Add(read, hn::Mul(along[column], m[row][column]));
    }
    return read;
}

template <int kU, int kV>
HWY_INLINE void sumRays(const RayPatch& patch, const RayRun& rays, std::size_t i) {
    const EightTag tag;
    using V = hn::Vec<EightTag>;
    const auto slopeU = hn::LoadU(tag, rays.slopeU + i);
    const auto slopeV = hn::LoadU(tag, rays.slopeV + i);
    const auto inverse = [&](V slope) {
        const auto one = hn::Set(tag, 1.0f);
        const auto none = hn::Eq(slope, hn::Zero(tag));
        return hn::IfThenZeroElse(none, hn::Div(one, hn::IfThenElse(none, one, slope)));
    };
    const auto inverseU = inverse(slopeU);
    const auto inverseV = inverse(slopeV);
    const auto firstSlice = hn::LoadU(tag, rays.firstSlice + i);
    Sum<V> sum{hn::LoadU(tag, rays.found + i), hn::LoadU(tag, rays.rest + i)};
    Sum<V> share{hn::Zero(tag), hn::Zero(tag)};
    if (rays.share) share = {hn::LoadU(tag, rays.share + i), hn::LoadU(tag, rays.shareRest + i)};
    for (int s = 0; s < patch.slices; ++s) {
        const auto counts = hn::Ge(hn::Set(tag, float(s)), firstSlice);
        // From the slice before, where the slice's tent begins.
        const auto begin = hn::Set(tag, float(s - 1));
        const Reading<V> at = readingAt(patch, rays, i, begin, slopeU, slopeV);
        V m[4][4];
        takeMoments<kU, kV>({at.u, slopeU, inverseU}, {at.v, slopeV, inverseV}, m);
        const std::ptrdiff_t slice = s * patch.sliceStep;
        sum.add(hn::IfThenElseZero(
            counts, integral<kU, kV>(patch.values + slice, patch.sizeV, at.offsets, m)));
        if (!rays.share) continue;
        const auto active = patch.active
                                ? integral<kU, kV>(patch.active + slice, patch.sizeV, at.offsets, m)
                                : hn::Set(tag, 1.0f);
        share.add(hn::IfThenElseZero(counts, active));
    }
    hn::StoreU(sum.sum, tag, rays.found + i);
    hn::StoreU(sum.rest, tag, rays.rest + i);
    if (!rays.share) return;
    hn::StoreU(share.sum, tag, rays.share + i);
    hn::StoreU(share.rest, tag, rays.shareRest + i);
}

// Calls use(i) for the vectors of bundles; `i` is a first line.
template <class Use>
HWY_INLINE void forVectors(const RayRun& rays, const Use& use) {
    for (std::size_t n = 0; n < rays.count; ++n) {
        const std::size_t first = kRayBundle * rays.bundles[n];
        for (std::size_t i = 0; i < kRayBundle; i += hn::Lanes(EightTag())) use(first + i);
    }
}

// Voxels along an axis that a ray may read in the tent of a slice.
HWY_INLINE int voxelsOf(const float* slopes) {
    const EightTag tag;
    float most = 0;
    for (std::size_t i = 0; i < hn::Lanes(tag); ++i) most = slopes[i] > most ? slopes[i] : most;
    return most == 0 ? 2 : most <= 0.5f ? 3 : 4;
}

template <int kU>
HWY_INLINE void sumRaysOf(const RayPatch& patch, const RayRun& rays, std::size_t i) {
    switch (voxelsOf(rays.slopeV + i)) {
        case 2:
            return sumRays<kU, 2>(patch, rays, i);
        case 3:
            return sumRays<kU, 3>(patch, rays, i);
        default:
            return sumRays<kU, 4>(patch, rays, i);
    }
}

void sumSlicesKernel(const RayPatch& patch, const RayRun& rays) {
    forVectors(rays, [&](std::size_t i) {
        switch (voxelsOf(rays.slopeU + i)) {
            case 2:
                return sumRaysOf<2>(patch, rays, i);
            case 3:
                return sumRaysOf<3>(patch, rays, i);
            default:
                return sumRaysOf<4>(patch, rays, i);
        }
    });
}

// Loads the 3x3 voxels around a ray, in two slices.
template <class V>
HWY_INLINE void loadCells(const float* values, const RayPatch& patch, const std::int32_t* offsets,
                          V (*cells)[3][3]) {
    for (int slice = 0; slice < 2; ++slice) {
        for (int row = 0; row < 3; ++row) {
            const Fours<V> fours = loadFours(
                values + slice * patch.sliceStep + row * std::ptrdiff_t{patch.sizeV}, offsets);
            for (int column = 0; column < 3; ++column) cells[slice][row][column] = fours.at[column];
        }
    }
}

// Shares of three neighbouring voxels, 0 <= x <= 2 behind the first.
template <class V>
HWY_INLINE void takeShares(V x, V* shares) {
    const EightTag tag;
    const auto zero = hn::Zero(tag);
    const auto one = hn::Set(tag, 1.0f);
    shares[0] = hn::Max(hn::Sub(one, x), zero);
    shares[1] = hn::Min(x, hn::Sub(hn::Set(tag, 2.0f), x));
    shares[2] = hn::Max(hn::Sub(x, one), zero);
}

template <class V>
HWY_INLINE V mixed(const V* values, const V* shares) {
    return hn::Add(hn::Add(hn::Mul(values[0], shares[0]), hn::Mul(values[1], shares[1])),
                   hn::Mul(values[2], shares[2]));
}

// Interpolates cells linearly along all axes.
template <class V>
HWY_INLINE V readCells(const V (*cells)[3][3], const V* sharesU, const V* sharesV, V way) {
    V slices[2];
    for (int slice = 0; slice < 2; ++slice) {
        V rows[3];
        for (int row = 0; row < 3; ++row) rows[row] = mixed(cells[slice][row], sharesV);
        slices[slice] = mixed(rows, sharesU);
    }
    const auto rest = hn::Sub(hn::Set(EightTag(), 1.0f), way);
    return hn::Add(hn::Mul(rest, slices[0]), hn::Mul(way, slices[1]));
}

// Largest value of the cells; with `active`, of active ones.
template <class V>
HWY_INLINE V largestOf(const V (*cells)[3][3], const V (*active)[3][3]) {
    const EightTag tag;
    const auto nothing = hn::Set(tag, -std::numeric_limits<float>::infinity());
    auto largest = nothing;
    for (int slice = 0; slice < 2; ++slice) {
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) {
                auto value = cells[slice][row][column];
                if (active)
                    value = hn::IfThenElse(hn::Gt(active[slice][row][column], hn::Zero(tag)), value,
                                           nothing);
                largest = hn::Max(largest, value);
            }
        }
    }
    return largest;
}

template <class V>
HWY_INLINE auto areWhole(const V (*active)[3][3]) {
    auto least = active[0][0][0];
    for (int slice = 0; slice < 2; ++slice)
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                least = hn::Min(least, active[slice][row][column]);
    return hn::Eq(least, hn::Set(EightTag(), 1.0f));
}

// A smaller share of a voxel is due to rounding.
constexpr float kLeastShare = 0x1p-20f;

// The largest values that rays can read between a slice and the next.
template <class V>
HWY_INLINE V topsAt(const RayPatch& patch, const Reading<V>& at, int slice) {
    const EightTag tag;
    HWY_ALIGN float found[8];
    const float* const tops = patch.tops + std::ptrdiff_t{slice} * patch.topsU * patch.topsV;
    for (std::size_t k = 0; k < hn::Lanes(tag); ++k) found[k] = tops[at.tops[k]];
    return hn::Load(tag, found);
}

template <class V>
HWY_INLINE void maxBetween(const RayPatch& patch, const RayRun& rays, std::size_t i, int slice) {
    const EightTag tag;
    const auto slopeU = hn::LoadU(tag, rays.slopeU + i);
    const auto slopeV = hn::LoadU(tag, rays.slopeV + i);
    const auto number = hn::Set(tag, float(slice));
    const Reading<V> at = readingAt(patch, rays, i, number, slopeU, slopeV);
    const auto depth = hn::Set(tag, rays.depth + float(slice));
    auto largest = hn::LoadU(tag, rays.found + i);
    auto met = hn::LoadU(tag, rays.met + i);
    auto place = hn::LoadU(tag, rays.rest + i);
    const bool allMet = hn::AllTrue(tag, hn::Gt(met, hn::Zero(tag)));
    // A larger value, or an equal one at a nearer, visible place.
    const auto isBetter = [&](V value, V at) {
        return hn::Or(hn::Gt(value, largest), hn::And(hn::Eq(value, largest), hn::Lt(at, place)));
    };
    if (allMet && hn::AllFalse(tag, isBetter(topsAt<V>(patch, at, slice), depth))) return;
    const std::ptrdiff_t first = slice * patch.sliceStep;
    V values[2][3][3], active[2][3][3];
    loadCells(patch.values + first, patch, at.offsets, values);
    const bool readsActive = patch.active && (patch.leavesOut || !allMet);
    if (readsActive) loadCells(patch.active + first, patch, at.offsets, active);
    // Per line, so that results do not depend on the number of lanes.
    const auto top = largestOf(values, patch.leavesOut ? active : nullptr);
    const auto mayFind = isBetter(top, depth);
    if (allMet && hn::AllFalse(tag, mayFind)) return;
    const auto one = hn::Set(tag, 1.0f);
    const auto firstSlice = hn::LoadU(tag, rays.firstSlice + i);
    for (int step = 0; step < kRaySteps; ++step) {
        const auto way = hn::Set(tag, float(step) / kRaySteps);
        V sharesU[3], sharesV[3];
        takeShares(hn::Add(at.u, hn::Mul(way, slopeU)), sharesU);
        takeShares(hn::Add(at.v, hn::Mul(way, slopeV)), sharesV);
        auto counts = hn::Ge(hn::Add(number, way), firstSlice);
        auto value = readCells(values, sharesU, sharesV, way);
        auto isSeen = counts;
        if (readsActive) {
            const auto share = readCells(active, sharesU, sharesV, way);
            isSeen = hn::And(hn::Gt(share, hn::Set(tag, kLeastShare)), counts);
            if (patch.leavesOut) {
                counts = isSeen;
                value = hn::Div(value,
                                hn::IfThenElse(hn::AndNot(areWhole(active), isSeen), share, one));
            }
        }
        if (readsActive || !patch.active) met = hn::IfThenElse(isSeen, one, met);
        // Rounding must not exceed the largest input, so that skipping changes nothing.
        value = hn::Min(value, top);
        const auto here = hn::Add(depth, way);
        const auto better = hn::And(hn::And(counts, mayFind), isBetter(value, here));
        largest = hn::IfThenElse(better, value, largest);
        place = hn::IfThenElse(better, here, place);
    }
    hn::StoreU(largest, tag, rays.found + i);
    hn::StoreU(met, tag, rays.met + i);
    hn::StoreU(place, tag, rays.rest + i);
}

void maxSlicesKernel(const RayPatch& patch, const RayRun& rays) {
    forVectors(rays, [&](std::size_t i) {
        for (int slice = 0; slice + 1 < patch.slices; ++slice)
            maxBetween<hn::Vec<EightTag>>(patch, rays, i, slice);
    });
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(sumSlicesKernel);
HWY_EXPORT(maxSlicesKernel);

void sumSlices(const RayPatch& patch, const RayRun& rays) {
    HWY_DYNAMIC_DISPATCH(sumSlicesKernel)(patch, rays);
}

void maxSlices(const RayPatch& patch, const RayRun& rays) {
    HWY_DYNAMIC_DISPATCH(maxSlicesKernel)(patch, rays);
}

}  // namespace deltasplat
#endif
