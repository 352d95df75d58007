// SPDX-License-Identifier: Apache-2.0
// The warp's inner loop, compiled once per SIMD level. Sums run in a fixed order whatever a
// vector's width, so all levels give the same bits.
#include "screen/warp_kernels.h"

#include <limits>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "screen/warp_kernels.cpp"
#include "hwy/foreach_target.h"
// Highway requires this after foreach_target.h.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using PixelTag = hn::FixedTag<float, 4>;

using PixelVector = hn::Vec<PixelTag>;

// The middle taps of an axis, to whose range sums are clamped.
struct Inner {
    int first, end;

    static Inner of(const FilterView& filter) {
        return {filter.firstInnerTap(), filter.firstInnerTap() + filter.innerTaps()};
    }
};

// Numbers of taps known at compile time, or 0: columns with padding, and rows.
template <int kColumnTaps, int kRowTaps>
struct KnownTaps {
    // For a sharp filter of that many taps.
    static constexpr int kInnerRows = kRowTaps == 4 ? 2 : 4;

    static constexpr bool kFourColumns = kColumnTaps == 4;

    static bool areThoseOf(const FilterView& filterX, const FilterView& filterY) {
        const auto isSharp = [](const FilterView& filter, int inner) {
            return !filter.overshoots() || filter.innerTaps() == inner;
        };
        return filterX.paddedTaps() == kColumnTaps && isSharp(filterX, kFourColumns ? 2 : 4) &&
               filterY.taps() == kRowTaps && isSharp(filterY, kInnerRows);
    }
    static int columns(const FilterView& filterX) {
        return kColumnTaps ? kColumnTaps : filterX.paddedTaps();
    }
    static int rows(const FilterView& filterY) { return kRowTaps ? kRowTaps : filterY.taps(); }
    static Inner innerRows(const FilterView& filterY) {
        return kRowTaps ? Inner{(kRowTaps - kInnerRows) / 2, (kRowTaps + kInnerRows) / 2}
                        : Inner::of(filterY);
    }
};

// Sums columns over all rows. With kClamp, each sum is clamped to the range of its inner rows.
template <class Known, bool kClamp, class Tag>
HWY_INLINE hn::Vec<Tag> sumRows(Tag tag, const float* corner, std::size_t pitch,
                                const FilterView& filterY, const float* weightY) {
    auto sum = hn::Mul(hn::LoadU(tag, corner), hn::Set(tag, weightY[0]));
    for (int j = 1; j < Known::rows(filterY); ++j) {
        sum = hn::Add(sum, hn::Mul(hn::LoadU(tag, corner + j * pitch), hn::Set(tag, weightY[j])));
    }
    if constexpr (kClamp) {
        const Inner inner = Known::innerRows(filterY);
        auto low = hn::LoadU(tag, corner + inner.first * pitch);
        auto high = low;
        for (int j = inner.first + 1; j < inner.end; ++j) {
            const auto row = hn::LoadU(tag, corner + j * pitch);
            low = hn::Min(low, row);
            high = hn::Max(high, row);
        }
        sum = hn::Min(hn::Max(sum, low), high);
    }
    return sum;
}

// The RGBA of a raster's only channel at 1.
HWY_INLINE PixelVector colorOf(const Raster& raster) {
    HWY_ALIGN const float rgba[4] = {raster.color.x, raster.color.y, raster.color.z, 1};
    return hn::Load(PixelTag(), rgba);
}

// Four neighbouring columns of a raster, in as many vectors as needed.
template <int kChannels>
struct FourColumns {
    using Tag = hn::CappedTag<float, 4 * kChannels>;
    static constexpr int kLanes = int(hn::MaxLanes(Tag()));
    static constexpr int kParts = 4 * kChannels / kLanes;

    hn::Vec<Tag> parts[kParts];

    HWY_INLINE explicit FourColumns(float value) {
        for (auto& part : parts) part = hn::Set(Tag(), value);
    }

    // Spreads four columns' weights over the lanes of their columns.
    HWY_INLINE static hn::Vec<Tag> spread(const float* weights, int part) {
        const Tag tag;
        const auto four = hn::LoadDup128(tag, weights);
        if constexpr (kChannels == 1) return four;
        HWY_ALIGN std::int32_t columns[kLanes];
        for (int lane = 0; lane < kLanes; ++lane)
            columns[lane] = (part * kLanes + lane) / kChannels;
        return hn::TableLookupLanes(four, hn::SetTableIndices(tag, columns));
    }

    // Joins columns 0 and 2, columns 1 and 3, and then both results, whatever a vector's width.
    // With a single channel, all lanes hold the result.
    template <class Join>
    HWY_INLINE PixelVector joined(const Join& join) const {
        if constexpr (kChannels == 1) {
            const PixelVector pairs = join(parts[0], hn::Shuffle1032(parts[0]));
            return join(pairs, hn::Shuffle2301(pairs));
        } else if constexpr (kParts == 4) {
            return join(join(parts[0], parts[2]), join(parts[1], parts[3]));
        } else if constexpr (kParts == 2) {
            return joinedHalves(Tag(), join(parts[0], parts[1]), join);
        } else {
            return joinedHalves(hn::Half<Tag>(), joinedHalves(Tag(), parts[0], join), join);
        }
    }

    // Returns column 1 or 2.
    template <int kColumn>
    HWY_INLINE PixelVector inner() const {
        static_assert(kColumn == 1 || kColumn == 2);
        if constexpr (kChannels == 1) {
            return hn::Broadcast<kColumn>(parts[0]);
        } else if constexpr (kParts == 4) {
            return parts[kColumn];
        } else if constexpr (kParts == 2) {
            return kColumn == 1 ? upperHalf(Tag(), parts[0]) : lowerHalf(Tag(), parts[1]);
        } else {
            const hn::Half<Tag> two;
            return kColumn == 1 ? upperHalf(two, lowerHalf(Tag(), parts[0]))
                                : lowerHalf(two, upperHalf(Tag(), parts[0]));
        }
    }

  private:
    template <class Whole>
    HWY_INLINE static auto lowerHalf(Whole, hn::Vec<Whole> both) {
        return hn::LowerHalf(hn::Half<Whole>(), both);
    }
    template <class Whole>
    HWY_INLINE static auto upperHalf(Whole, hn::Vec<Whole> both) {
        return hn::UpperHalf(hn::Half<Whole>(), both);
    }
    template <class Whole, class Join>
    HWY_INLINE static auto joinedHalves(Whole whole, hn::Vec<Whole> both, const Join& join) {
        return join(lowerHalf(whole, both), upperHalf(whole, both));
    }
};

// Returns one pixel: RGBA, or a single channel's sum in all lanes. With kClamp, sums are clamped to
// the inner taps' range along one axis after the other, so no jump shows where these change.
template <class Known, int kChannels, bool kClamp>
HWY_INLINE PixelVector samplePixel(const FilterView& filterX, std::uint32_t x,
                                   const FilterView& filterY, std::uint32_t y, const float* corner,
                                   std::size_t pitch) {
    using Columns = FourColumns<kChannels>;
    const typename Columns::Tag tag;
    const float* weightX = filterX.weights(x);
    const float* weightY = filterY.weights(y);
    const Inner inner = Inner::of(filterX);
    const auto firstInner = hn::Set(tag, float(kChannels * inner.first));
    const auto endInner = hn::Set(tag, float(kChannels * inner.end));
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Columns columns(0);
    Columns sum(0);
    Columns low(kInfinity);
    Columns high(-kInfinity);
    for (int first = 0; first < Known::columns(filterX); first += 4) {
        for (int part = 0; part < Columns::kParts; ++part) {
            const int at = kChannels * first + part * Columns::kLanes;
            const auto column = sumRows<Known, kClamp>(tag, corner + at, pitch, filterY, weightY);
            const auto weighted = hn::Mul(column, Columns::spread(weightX + first, part));
            columns.parts[part] = column;
            sum.parts[part] = hn::Add(sum.parts[part], weighted);
            if constexpr (!kClamp || Known::kFourColumns) continue;
            const auto lane = hn::Iota(tag, float(at));
            const auto isInner = hn::And(hn::Ge(lane, firstInner), hn::Lt(lane, endInner));
            const auto orLess = hn::IfThenElse(isInner, column, hn::Set(tag, kInfinity));
            const auto orMore = hn::IfThenElse(isInner, column, hn::Set(tag, -kInfinity));
            low.parts[part] = hn::Min(low.parts[part], orLess);
            high.parts[part] = hn::Max(high.parts[part], orMore);
        }
    }
    const auto all = sum.joined([](auto a, auto b) { return hn::Add(a, b); });
    if constexpr (!kClamp) {
        return all;
    } else if constexpr (Known::kFourColumns) {
        const PixelVector one = columns.template inner<1>();
        const PixelVector other = columns.template inner<2>();
        return hn::Min(hn::Max(all, hn::Min(one, other)), hn::Max(one, other));
    } else {
        const auto lowest = low.joined([](auto a, auto b) { return hn::Min(a, b); });
        const auto highest = high.joined([](auto a, auto b) { return hn::Max(a, b); });
        return hn::Min(hn::Max(all, lowest), highest);
    }
}

// Positions of a run of pixels: evenly spaced or arbitrary.
struct EvenPositions {
    FixedPosition position, step;

    FixedPosition next() {
        const FixedPosition here = position;
        position.x += step.x;
        position.y += step.y;
        return here;
    }
};
struct AnyPositions {
    const FixedPosition* position;

    FixedPosition next() { return *position++; }
};

struct Sampling {
    const Raster& raster;
    const FilterTable& filterX;
    const FilterTable& filterY;
    int pixels;
    float* out;
};

template <class Known, int kChannels, bool kClamp, class Positions>
void sampleOf(const Sampling& what, Positions positions) {
    const Raster& raster = what.raster;
    const std::size_t pitch = std::size_t(kChannels) * raster.size.x;
    // Copies, so that the compiler knows that writes do not change them.
    const FilterView filterX(what.filterX);
    const FilterView filterY(what.filterY);
    const PixelVector color = colorOf(raster);
    float* out = what.out;
    for (int i = 0; i < what.pixels; ++i, out += 4) {
        const FixedPosition position = positions.next();
        const float* corner = raster.values + filterY.firstTap(int(position.y >> 32)) * pitch +
                              kChannels * filterX.firstTap(int(position.x >> 32));
        PixelVector sum = samplePixel<Known, kChannels, kClamp>(
            filterX, std::uint32_t(position.x), filterY, std::uint32_t(position.y), corner, pitch);
        if constexpr (kChannels == 1) sum = hn::Mul(sum, color);
        hn::StoreU(sum, PixelTag(), out);
    }
}

template <class Known, class Positions>
void sampleOf(const Sampling& what, Positions positions) {
    const bool isColored = what.raster.channels == 4;
    if (what.filterX.overshoots())
        isColored ? sampleOf<Known, 4, true>(what, positions)
                  : sampleOf<Known, 1, true>(what, positions);
    else
        isColored ? sampleOf<Known, 4, false>(what, positions)
                  : sampleOf<Known, 1, false>(what, positions);
}

// Samples if the filters have these numbers of taps.
template <int kColumnTaps, int kRowTaps, class Positions>
bool sampleBy(const Sampling& what, const Positions& positions) {
    using Known = KnownTaps<kColumnTaps, kRowTaps>;
    if (!Known::areThoseOf(what.filterX, what.filterY)) return false;
    sampleOf<Known>(what, positions);
    return true;
}

template <class Positions>
void sampleOf(const Sampling& what, const Positions& positions) {
    // Sharp filters of stretch 1 to 2.
    const bool isDone = sampleBy<4, 4>(what, positions) || sampleBy<4, 6>(what, positions) ||
                        sampleBy<4, 8>(what, positions) || sampleBy<8, 4>(what, positions) ||
                        sampleBy<8, 6>(what, positions) || sampleBy<8, 8>(what, positions);
    if (!isDone) sampleOf<KnownTaps<0, 0>>(what, positions);
}

void sampleRunKernel(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
                     FixedPosition position, FixedPosition step, int pixels, float* out) {
    sampleOf({raster, filterX, filterY, pixels, out}, EvenPositions{position, step});
}

void sampleAtKernel(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
                    const FixedPosition* positions, int pixels, float* out) {
    sampleOf({raster, filterX, filterY, pixels, out}, AnyPositions{positions});
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(sampleRunKernel);
HWY_EXPORT(sampleAtKernel);

void sampleRun(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
               FixedPosition position, FixedPosition step, int pixels, float* out) {
    HWY_DYNAMIC_DISPATCH(sampleRunKernel)
    (raster, filterX, filterY, position, step, pixels, out);
}

void sampleAt(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
              const FixedPosition* positions, int pixels, float* out) {
    HWY_DYNAMIC_DISPATCH(sampleAtKernel)(raster, filterX, filterY, positions, pixels, out);
}

}  // namespace deltasplat
#endif
