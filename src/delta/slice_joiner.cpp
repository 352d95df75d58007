// SPDX-License-Identifier: Apache-2.0
// Joining slices, its inner loops compiled once for each SIMD level.
#include "delta/slice_joiner.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "delta/slice_joiner.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

#ifndef DELTASPLAT_SUM_LEVELS
#define DELTASPLAT_SUM_LEVELS
namespace deltasplat {

// Levels that sums are rounded to: floats without their lowest bits, as many to each octave.
struct SumLevels {
    // Of the 23 bits behind a float's point.
    static constexpr int kDroppedBits = 13;

    const float* shares;  // [classes]: what is added up
    std::int32_t first;   // the bits of the least level
    std::int32_t count;   // what is above them all has a level of its own
};

// Two slices, as SliceJoiner::join takes them.
struct SlicePair {
    const ClassIndex* first;
    const ClassIndex* second;
    std::size_t pitch;
};

}  // namespace deltasplat
#endif

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void joinPairsKernel(const SlicePair& slices, std::size_t classCount,
                     ClassIndex* HWY_RESTRICT out) {
    const hn::CappedTag<std::uint16_t, 8> tag;
    const auto count = hn::Set(tag, std::uint16_t(classCount));
    for (std::size_t u = 0; u < 8; ++u) {
        for (std::size_t v = 0; v < 8; v += hn::Lanes(tag)) {
            const std::size_t n = u * slices.pitch + v;
            const auto pair = hn::Mul(hn::LoadU(tag, slices.first + n), count);
            hn::StoreU(hn::Add(pair, hn::LoadU(tag, slices.second + n)), tag, out + 8 * u + v);
        }
    }
}

bool anyClass(const SlicePair& slices) {
    const hn::CappedTag<std::uint16_t, 8> tag;
    auto any = hn::Zero(tag);
    for (std::size_t u = 0; u < 8; ++u) {
        for (std::size_t v = 0; v < 8; v += hn::Lanes(tag)) {
            const std::size_t n = u * slices.pitch + v;
            any = hn::Or(
                any, hn::Or(hn::LoadU(tag, slices.first + n), hn::LoadU(tag, slices.second + n)));
        }
    }
    return !hn::AllTrue(tag, hn::Eq(any, hn::Zero(tag)));
}

void joinSumsKernel(const SlicePair& slices, const SumLevels& levels,
                    ClassIndex* HWY_RESTRICT out) {
    if (!anyClass(slices)) {
        std::fill_n(out, 64, ClassIndex{0});
        return;
    }
    const hn::CappedTag<float, 8> tag;
    const hn::RebindToSigned<decltype(tag)> integers;
    const hn::Rebind<std::uint16_t, decltype(tag)> shorts;
    const auto half = hn::Set(integers, 1 << (SumLevels::kDroppedBits - 1));
    const auto least = hn::Set(integers, levels.first);
    const auto last = hn::Set(integers, levels.count);
    const auto shareOf = [&](const ClassIndex* classes) {
        const auto indices = hn::PromoteTo(integers, hn::LoadU(shorts, classes));
        return hn::GatherIndex(tag, levels.shares, indices);
    };
    for (std::size_t u = 0; u < 8; ++u) {
        for (std::size_t v = 0; v < 8; v += hn::Lanes(tag)) {
            const std::size_t n = u * slices.pitch + v;
            const auto sum = hn::Add(shareOf(slices.first + n), shareOf(slices.second + n));
            // The bits of floats that are not negative are in the order of the numbers.
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

// Of what stands for a sum beyond all that can be told apart.
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

SliceJoiner SliceJoiner::ofSums(const std::vector<double>& extinctions) {
    SliceJoiner joiner;
    double largest = 0;
    double smallest = std::numeric_limits<double>::infinity();
    for (const double extinction : extinctions) {
        joiner.hasOpaque_ = joiner.hasOpaque_ || std::isinf(extinction);
        if (!(extinction > 0) || std::isinf(extinction)) continue;
        largest = std::max(largest, extinction);
        smallest = std::min(smallest, extinction);
    }
    // A power of two, by which levels of other classes are the same numbers.
    int exponent = 0;
    if (largest > 0) std::frexp(largest, &exponent);
    joiner.unit_ = std::ldexp(1.0, std::min(exponent, 1023));
    // What is less than the least level looks like it: nothing that is seen becomes empty. 1024
    // levels for each of 62 octaves are fewer than there are numbers for.
    constexpr double kLeast = 0x1p-58;
    for (const double extinction : extinctions) {
        const double share = std::max(extinction / joiner.unit_, extinction > 0 ? kLeast : 0);
        joiner.shares_.push_back(std::isinf(extinction) ? kOpaque : float(share));
    }
    joiner.first_ = roundedBits(float(std::clamp(smallest / joiner.unit_, kLeast, 1.0)));
    const float most = float(largest / joiner.unit_);
    joiner.count_ = std::max(roundedBits(most + most) - joiner.first_, 0) + 1;
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
                       ClassIndex* out) const {
    const SlicePair pair{slices[0], slices[1], pitch};
    if (classCount_ > 0) {
        HWY_DYNAMIC_DISPATCH(joinPairsKernel)(pair, classCount_, out);
    } else {
        const SumLevels levels{shares_.data(), first_, count_};
        HWY_DYNAMIC_DISPATCH(joinSumsKernel)(pair, levels, out);
    }
}

}  // namespace deltasplat
#endif
