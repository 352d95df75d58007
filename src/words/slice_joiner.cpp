// SPDX-License-Identifier: Apache-2.0
// Joining slices; inner loops compiled once per SIMD level.
#include "words/slice_joiner.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/simd_targets.h"
#include "words/joined_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "words/slice_joiner.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "words/joined_rows-inl.h"

#ifndef DELTASPLAT_SUM_LEVELS
#define DELTASPLAT_SUM_LEVELS
namespace deltasplat {

// Rounding levels of sums: floats without their lowest bits, equally many per octave.
struct SumLevels {
    // Of a float's 23 mantissa bits.
    static constexpr int kDroppedBits = 13;

    const float* shares;  // [class]: summands
    std::int32_t first;   // bits of the smallest level
    std::int32_t count;   // larger sums share one more level
};

}  // namespace deltasplat
#endif

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void joinPairsKernel(const JoinedRows& rows, std::size_t classCount, ClassIndex* HWY_RESTRICT out) {
    for (std::size_t u = 0; u < 8; ++u) {
        const std::size_t n = u * rows.pitch;
        numberPairs(rows.slices[0] + n, rows.slices[1] + n, classCount, out + 8 * u);
    }
}

void joinSumsKernel(const JoinedRows& rows, const SumLevels& levels, ClassIndex* HWY_RESTRICT out) {
    const hn::CappedTag<float, 8> tag;
    const hn::RebindToSigned<decltype(tag)> integers;
    const hn::Rebind<std::uint16_t, decltype(tag)> shorts;
    const auto half = hn::Set(integers, 1 << (SumLevels::kDroppedBits - 1));
    const auto least = hn::Set(integers, levels.first);
    const auto last = hn::Set(integers, levels.count);
    const auto shareOf = [&](std::size_t slice, std::size_t n) {
        const auto indices = hn::PromoteTo(integers, hn::LoadU(shorts, rows.slices[slice] + n));
        return hn::GatherIndex(tag, levels.shares, indices);
    };
    for (std::size_t u = 0; u < 8; ++u) {
        if (!anyClass(rows, u * rows.pitch)) {
            std::fill_n(out + 8 * u, 8, ClassIndex{0});
            continue;
        }
        for (std::size_t v = 0; v < 8; v += hn::Lanes(tag)) {
            const std::size_t n = u * rows.pitch + v;
            auto sum = shareOf(0, n);
            for (std::size_t slice = 1; slice < rows.count; ++slice)
                sum = hn::Add(sum, shareOf(slice, n));
            // Bits of non-negative floats sort like the floats.
            const auto bits =
                hn::ShiftRight<SumLevels::kDroppedBits>(hn::Add(hn::BitCast(integers, sum), half));
            const auto level = hn::Min(hn::Sub(hn::Max(bits, least), least), last);
            const auto number = hn::Add(level, hn::Set(integers, 1));
            const auto isEmpty = hn::Eq(bits, hn::Zero(integers));
            hn::StoreU(hn::DemoteTo(shorts, hn::IfThenZeroElse(isEmpty, number)), shorts,
                       out + 8 * u + v);
        }
    }
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {
namespace {

HWY_EXPORT(joinPairsKernel);
HWY_EXPORT(joinSumsKernel);

// Stands for a sum too large to be told apart.
constexpr float kOpaque = 0x1p100F;

std::int32_t roundedBits(float value) {
    constexpr int kDropped = SumLevels::kDroppedBits;
    return (std::bit_cast<std::int32_t>(value) + (1 << (kDropped - 1))) >> kDropped;
}

}  // namespace

SliceJoiner SliceJoiner::ofPairs(std::size_t classCount) {
    SliceJoiner joiner;
    joiner.classCount_ = classCount;
    return joiner;
}

SliceJoiner SliceJoiner::ofLooks(const std::vector<glm::dvec4>& lights, const LookRun& run) {
    SliceJoiner joiner;
    joiner.looks_.emplace(lights, run);
    return joiner;
}

SliceJoiner SliceJoiner::ofSums(const std::vector<double>& extinctions, int slices) {
    SliceJoiner joiner;
    double largest = 0;
    double smallest = std::numeric_limits<double>::infinity();
    for (const double extinction : extinctions) {
        joiner.hasOpaque_ = joiner.hasOpaque_ || std::isinf(extinction);
        if (!(extinction > 0) || std::isinf(extinction)) continue;
        largest = std::max(largest, extinction);
        smallest = std::min(smallest, extinction);
    }
    // A power of two keeps the levels independent of other classes.
    int exponent = 0;
    if (largest > 0) std::frexp(largest, &exponent);
    joiner.unit_ = std::ldexp(1.0, std::min(exponent, 1023));
    // Smaller sums get the smallest level, so nothing visible becomes empty. 1024 levels per octave
    // for 63 octaves, up to kMostJoined times the largest, fit into the numbers.
    constexpr double kLeast = 0x1p-58;
    for (const double extinction : extinctions) {
        const double share = std::max(extinction / joiner.unit_, extinction > 0 ? kLeast : 0);
        joiner.shares_.push_back(std::isinf(extinction) ? kOpaque : float(share));
    }
    joiner.first_ = roundedBits(float(std::clamp(smallest / joiner.unit_, kLeast, 1.0)));
    const float most = float(largest / joiner.unit_);
    joiner.count_ = std::max(roundedBits(float(slices) * most) - joiner.first_, 0) + 1;
    return joiner;
}

std::vector<double> SliceJoiner::levels() const {
    std::vector<double> levels(1);
    for (std::int32_t i = 0; i < count_; ++i) {
        const std::int32_t bits = (first_ + i) << SumLevels::kDroppedBits;
        levels.push_back(unit_ * double(std::bit_cast<float>(bits)));
    }
    if (hasOpaque_) levels.push_back(std::numeric_limits<double>::infinity());
    return levels;
}

void SliceJoiner::join(std::span<const ClassIndex* const> slices, std::size_t pitch,
                       std::size_t slice, ClassIndex* out, LookCache& cache) const {
    const JoinedRows rows{slices.data(), slices.size(), pitch};
    if (looks_) {
        looks_->join(slices, pitch, slice, out, cache);
    } else if (classCount_ > 0) {
        HWY_DYNAMIC_DISPATCH(joinPairsKernel)(rows, classCount_, out);
    } else {
        const SumLevels levels{shares_.data(), first_, count_};
        HWY_DYNAMIC_DISPATCH(joinSumsKernel)(rows, levels, out);
    }
}

}  // namespace deltasplat
#endif
