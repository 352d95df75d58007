// SPDX-License-Identifier: Apache-2.0
// The inner loops of line integrals and maxima, compiled once for each SIMD level.
// Based on: W. Kahan, "Further remarks on reducing truncation errors", 1965 (sums of many slices).
#include "rays/ray_kernels.h"

#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rays/ray_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FullTag = hn::ScalableTag<float>;
using EightTag = hn::CappedTag<float, 8>;
using CodeTag = hn::FixedTag<Code, 8>;

// Mirrors 8x8 codes at their diagonal; rows of `in` and `out` lie this far apart.
HWY_INLINE void transposeCodes(const Code* in, std::size_t inStep, Code* out, std::size_t outStep) {
    const CodeTag tag;
    const hn::RepartitionToWide<CodeTag> pairs;
    const hn::RepartitionToWide<decltype(pairs)> fours;
    const auto load = [&](int row) { return hn::LoadU(tag, in + row * inStep); };
    // After each step, runs of twice as many codes of one column are together.
    const auto four = [&](int row, auto& low, auto& high) {
        const auto a = load(row), b = load(row + 1), c = load(row + 2), d = load(row + 3);
        const auto abLow = hn::BitCast(pairs, hn::InterleaveLower(tag, a, b));
        const auto abHigh = hn::BitCast(pairs, hn::InterleaveUpper(tag, a, b));
        const auto cdLow = hn::BitCast(pairs, hn::InterleaveLower(tag, c, d));
        const auto cdHigh = hn::BitCast(pairs, hn::InterleaveUpper(tag, c, d));
        low[0] = hn::BitCast(fours, hn::InterleaveLower(pairs, abLow, cdLow));
        low[1] = hn::BitCast(fours, hn::InterleaveUpper(pairs, abLow, cdLow));
        high[0] = hn::BitCast(fours, hn::InterleaveLower(pairs, abHigh, cdHigh));
        high[1] = hn::BitCast(fours, hn::InterleaveUpper(pairs, abHigh, cdHigh));
    };
    hn::Vec<decltype(fours)> topLow[2], topHigh[2], bottomLow[2], bottomHigh[2];
    four(0, topLow, topHigh);
    four(4, bottomLow, bottomHigh);
    const auto store = [&](int row, auto top, auto bottom) {
        hn::StoreU(hn::BitCast(tag, hn::InterleaveLower(fours, top, bottom)), tag,
                   out + row * outStep);
        hn::StoreU(hn::BitCast(tag, hn::InterleaveUpper(fours, top, bottom)), tag,
                   out + (row + 1) * outStep);
    };
    for (int half = 0; half < 2; ++half) {
        store(2 * half, topLow[half], bottomLow[half]);
        store(4 + 2 * half, topHigh[half], bottomHigh[half]);
    }
}

// Puts the codes of a leaf into (slice, u, v) order.
HWY_INLINE const Code* inSliceOrder(const Code* codes, int sliceAxis, Code* ordered) {
    if (sliceAxis == 0) return codes;
    for (std::size_t i = 0; i < 8; ++i) {
        if (sliceAxis == 1) {
            transposeCodes(codes + 8 * i, 64, ordered + 64 * i, 8);
        } else {
            transposeCodes(codes + 64 * i, 8, ordered + 8 * i, 64);
        }
    }
    return ordered;
}

template <bool kDirect>
HWY_INLINE void storeValues(const Code* codes, const CodeValues& values, const BlockPlace& place) {
    const EightTag tag;
    const hn::Rebind<std::int32_t, EightTag> wide;
    const hn::Rebind<Code, EightTag> narrow;
    const auto offset = hn::Set(tag, values.offset);
    for (std::size_t slice = 0; slice < 8; ++slice) {
        for (std::size_t u = 0; u < 8; ++u, codes += 8) {
            float* out = place.first + slice * place.sliceStep + u * place.rowStep;
            for (std::size_t v = 0; v < 8; v += hn::Lanes(tag)) {
                const auto code = hn::PromoteTo(wide, hn::LoadU(narrow, codes + v));
                if constexpr (kDirect) {
                    hn::StoreU(hn::Add(hn::ConvertTo(tag, code), offset), tag, out + v);
                } else {
                    hn::StoreU(hn::GatherIndex(tag, values.table, code), tag, out + v);
                }
            }
        }
    }
}

void readBlockValuesKernel(const Code* codes, int sliceAxis, const CodeValues& values,
                           const BlockPlace& place) {
    HWY_ALIGN Code ordered[512];
    const Code* const from = inSliceOrder(codes, sliceAxis, ordered);
    values.direct ? storeValues<true>(from, values, place)
                  : storeValues<false>(from, values, place);
}

// Calls use(tag, i) for whole vectors of a multiple of eight values, then for what is left.
template <typename Use>
HWY_INLINE void forVectors(std::size_t count, const Use& use) {
    const FullTag full;
    const EightTag eight;
    std::size_t i = 0;
    for (; i + hn::Lanes(full) <= count; i += hn::Lanes(full)) use(full, i);
    for (; i < count; i += hn::Lanes(eight)) use(eight, i);
}

template <class V>
HWY_INLINE V between(V a, V b, V share) {
    return hn::Add(a, hn::Mul(share, hn::Sub(b, a)));
}

// Reads along the rows first, then along the columns.
template <bool kStraight, class Tag>
HWY_INLINE auto readSlice(Tag tag, const RaySpan& span, std::size_t i, glm::vec2 fraction) {
    if constexpr (kStraight) {
        return hn::LoadU(tag, span.row + i);
    } else {
        const auto down = hn::Set(tag, fraction.y);
        const auto here =
            between(hn::LoadU(tag, span.row + i), hn::LoadU(tag, span.nextRow + i), down);
        const auto next =
            between(hn::LoadU(tag, span.row + i + 1), hn::LoadU(tag, span.nextRow + i + 1), down);
        return between(here, next, hn::Set(tag, fraction.x));
    }
}

// Values of a vector that may be missing (NaN), and how much each weighs.
template <class V>
struct Weighed {
    V value, weight;
};

// The mean of two, by their weights; where only one counts, that one. Where both have the weights
// that the share gives them, it is `between`.
template <class Tag, class V>
HWY_INLINE Weighed<V> meanOf(Tag tag, const Weighed<V>& a, const Weighed<V>& b, V share) {
    const auto zero = hn::Zero(tag);
    const auto one = hn::Set(tag, 1.0f);
    const auto isWhole = [&](const Weighed<V>& part, V weight) {
        return hn::And(hn::Eq(part.weight, weight), hn::Eq(part.value, part.value));
    };
    const auto whole = hn::And(isWhole(a, hn::Sub(one, share)), isWhole(b, share));
    const auto sum = hn::Add(a.weight, b.weight);
    const auto mixed = between(a.value, b.value, hn::Div(b.weight, sum));
    const auto first = hn::IfThenElse(hn::Eq(b.weight, zero), a.value, mixed);
    const auto either = hn::IfThenElse(hn::Eq(a.weight, zero), b.value, first);
    return {hn::IfThenElse(whole, between(a.value, b.value, share), either),
            hn::IfThenElse(whole, one, sum)};
}

// Reads what is there, and takes the mean of it. Where all is, it reads as readSlice does.
template <bool kStraight, class Tag>
HWY_INLINE auto readActive(Tag tag, const RaySpan& span, std::size_t i, glm::vec2 fraction) {
    using V = hn::Vec<Tag>;
    const auto one = hn::Set(tag, 1.0f);
    const auto load = [&](const float* at, V weight) {
        const auto value = hn::LoadU(tag, at + i);
        return Weighed<V>{value, hn::IfThenElseZero(hn::Eq(value, value), weight)};
    };
    if constexpr (kStraight) {
        return load(span.row, one);
    } else {
        const auto down = hn::Set(tag, fraction.y);
        const auto right = hn::Set(tag, fraction.x);
        const auto column = [&](int x, V share) {
            auto mean = meanOf(tag, load(span.row + x, hn::Sub(one, down)),
                               load(span.nextRow + x, down), down);
            mean.weight = hn::Mul(mean.weight, share);
            return mean;
        };
        return meanOf(tag, column(0, hn::Sub(one, right)), column(1, right), right);
    }
}

// A slice's values, and where they count.
template <bool kStraight, bool kSkipsNaN, class Tag, class M>
HWY_INLINE auto readMet(Tag tag, const RaySpan& span, std::size_t i, glm::vec2 fraction, M& met) {
    if constexpr (kSkipsNaN) {
        const auto mean = readActive<kStraight>(tag, span, i, fraction);
        met = hn::And(met, hn::Gt(mean.weight, hn::Zero(tag)));
        return mean.value;
    } else {
        return readSlice<kStraight>(tag, span, i, fraction);
    }
}

template <bool kStraight>
void sumSpansOf(const std::vector<RaySpan>& spans, glm::vec2 fraction) {
    for (const RaySpan& span : spans) {
        float* HWY_RESTRICT plane = span.plane;
        float* HWY_RESTRICT rest = span.rest;
        forVectors(span.pixels, [&](auto tag, std::size_t i) {
            const auto read = readSlice<kStraight>(tag, span, i, fraction);
            const auto had = hn::LoadU(tag, plane + i);
            const auto more = hn::Sub(read, hn::LoadU(tag, rest + i));
            const auto sum = hn::Add(had, more);
            // Zeros add nothing, not even what is left of rounding.
            const auto none = hn::Eq(read, hn::Zero(tag));
            hn::StoreU(hn::IfThenElse(none, had, sum), tag, plane + i);
            const auto left = hn::Sub(hn::Sub(sum, had), more);
            hn::StoreU(hn::IfThenElse(none, hn::LoadU(tag, rest + i), left), tag, rest + i);
        });
    }
}

void sumSpansKernel(const std::vector<RaySpan>& spans, glm::vec2 fraction) {
    const bool straight = fraction.x == 0 && fraction.y == 0;
    straight ? sumSpansOf<true>(spans, fraction) : sumSpansOf<false>(spans, fraction);
}

// Keeps which slice the larger value is from.
template <class Tag, class V, class M>
HWY_INLINE void markPlaces(Tag tag, const RaySpan& span, std::size_t i, V had, V read, M met,
                           const SliceMark& slice) {
    const auto larger = slice.isNearer ? hn::Ge(read, had) : hn::Gt(read, had);
    float* place = span.places + i;
    hn::StoreU(
        hn::IfThenElse(hn::And(met, larger), hn::Set(tag, slice.number), hn::LoadU(tag, place)),
        tag, place);
}

template <bool kStraight, bool kSkipsNaN>
HWY_INLINE void maxMet(const RaySpan& span, glm::vec2 fraction, const SliceMark& slice) {
    const EightTag tag;
    float* HWY_RESTRICT plane = span.plane;
    for (std::size_t i = 0; i < span.pixels; i += hn::Lanes(tag)) {
        const std::uint8_t bits = std::uint8_t(span.mask[i / 8] >> (i % 8));
        auto met = hn::LoadMaskBits(tag, &bits);
        const auto had = hn::LoadU(tag, plane + i);
        const auto read = readMet<kStraight, kSkipsNaN>(tag, span, i, fraction, met);
        hn::StoreU(hn::IfThenElse(met, hn::Max(had, read), had), tag, plane + i);
        if (span.places) markPlaces(tag, span, i, had, read, met, slice);
    }
}

template <bool kStraight>
void maxSpansOf(const std::vector<RaySpan>& spans, glm::vec2 fraction, const SliceMark& slice,
                bool skipsNaN) {
    for (const RaySpan& span : spans) {
        if (span.mask) {
            skipsNaN ? maxMet<kStraight, true>(span, fraction, slice)
                     : maxMet<kStraight, false>(span, fraction, slice);
            continue;
        }
        float* HWY_RESTRICT plane = span.plane;
        forVectors(span.pixels, [&](auto tag, std::size_t i) {
            const auto read = readSlice<kStraight>(tag, span, i, fraction);
            const auto had = hn::LoadU(tag, plane + i);
            hn::StoreU(hn::Max(had, read), tag, plane + i);
            if (span.places) markPlaces(tag, span, i, had, read, hn::Eq(read, read), slice);
        });
    }
}

void maxSpansKernel(const std::vector<RaySpan>& spans, glm::vec2 fraction, const SliceMark& slice,
                    bool skipsNaN) {
    const bool straight = fraction.x == 0 && fraction.y == 0;
    straight ? maxSpansOf<true>(spans, fraction, slice, skipsNaN)
             : maxSpansOf<false>(spans, fraction, slice, skipsNaN);
}

template <class Tag>
HWY_INLINE void weighPixels(Tag tag, const float* const* rows, const float* weights, int width,
                            float scale, std::size_t x, float* out) {
    auto sum = hn::Zero(tag);
    for (int j = 0; j < width; ++j) {
        for (int i = 0; i < width; ++i) {
            const auto value = hn::LoadU(tag, rows[j] + x - i);
            sum = hn::Add(sum, hn::Mul(hn::Set(tag, weights[j * width + i]), value));
        }
    }
    hn::StoreU(hn::Mul(sum, hn::Set(tag, scale)), tag, out + x);
}

void weighRowKernel(const float* const* rows, const float* weights, int width, float scale,
                    std::size_t pixels, float* out) {
    const FullTag full;
    const hn::CappedTag<float, 1> one;
    std::size_t x = 0;
    for (; x + hn::Lanes(full) <= pixels; x += hn::Lanes(full))
        weighPixels(full, rows, weights, width, scale, x, out);
    for (; x < pixels; ++x) weighPixels(one, rows, weights, width, scale, x, out);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(readBlockValuesKernel);
HWY_EXPORT(sumSpansKernel);
HWY_EXPORT(maxSpansKernel);
HWY_EXPORT(weighRowKernel);

void readBlockValues(const Code* codes, int sliceAxis, const CodeValues& values,
                     const BlockPlace& place) {
    HWY_DYNAMIC_DISPATCH(readBlockValuesKernel)(codes, sliceAxis, values, place);
}

void sumSpans(const std::vector<RaySpan>& spans, glm::vec2 fraction) {
    HWY_DYNAMIC_DISPATCH(sumSpansKernel)(spans, fraction);
}

void maxSpans(const std::vector<RaySpan>& spans, glm::vec2 fraction, const SliceMark& slice,
              bool skipsNaN) {
    HWY_DYNAMIC_DISPATCH(maxSpansKernel)(spans, fraction, slice, skipsNaN);
}

void weighRow(const float* const* rows, const float* weights, int width, float scale,
              std::size_t pixels, float* out) {
    HWY_DYNAMIC_DISPATCH(weighRowKernel)(rows, weights, width, scale, pixels, out);
}

}  // namespace deltasplat
#endif
