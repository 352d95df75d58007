// SPDX-License-Identifier: Apache-2.0
// Joining looks; inner loops compiled once per SIMD level.
#include "words/look_joiner.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/portable_math.h"
#include "base/simd_targets.h"
#include "deltasplat/view/factorization.h"
#include "words/joined_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "words/look_joiner.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "words/joined_rows-inl.h"

#ifndef DELTASPLAT_LOOK_LEVELS
#define DELTASPLAT_LOOK_LEVELS
namespace deltasplat {

// Rounding levels of looks.
struct LookLevels {
    // Levels of x = A / (1 - A + kLeastRest), 0 to 1 / kLeastRest: fine near clear and near opaque.
    static constexpr float kLeastRest = 0x1p-12F;
    // Smaller values are seen as this.
    static constexpr float kLeast = 0x1p-60F;
    static constexpr int kMantissaBits = 23;  // of a float

    const float* lights;  // [classes][4]
    // [nearer][farther][4], or null.
    const float* pairs;
    std::size_t classCount;
    std::array<float, 3> perLargest;
    int opacityBits;
    int colorBits;
    // [64]: threshold added to a level before it is truncated, 0 to 1.
    const float* thresholds;
    std::uint16_t aloneClasses;  // as in LookJoiner
};

struct LookKeys {
    std::array<ClassIndex, 64> alone;    // number of a single class
    std::array<std::uint8_t, 8> others;  // [row]: voxels with several classes
    // Of voxels with several classes:
    std::array<std::uint32_t, 64> opacities;
    std::array<std::uint32_t, 64> colors;
};

}  // namespace deltasplat
#endif

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Rounds eight looks.
// @param lights      [8][4]: premultiplied, opacity last
// @param thresholds  [8]
HWY_INLINE void roundLooks(const LookLevels& levels, const float* lights, const float* thresholds,
                           std::uint32_t* opacities, std::uint32_t* colors) {
    const hn::CappedTag<float, 8> tag;
    const hn::RebindToSigned<decltype(tag)> integers;
    const hn::RebindToUnsigned<decltype(tag)> numbers;
    using V = hn::Vec<decltype(tag)>;
    const V one = hn::Set(tag, 1.0F);
    const V steps = hn::Set(tag, float((1 << levels.colorBits) - 1));
    const int dropped = LookLevels::kMantissaBits - levels.opacityBits;
    const V perLevel = hn::Set(tag, float(1 << dropped));
    for (std::size_t v = 0; v < 8; v += hn::Lanes(tag)) {
        const V threshold = hn::Load(tag, thresholds + v);
        const auto below = hn::ConvertTo(integers, hn::Mul(threshold, perLevel));
        V red, green, blue, alpha;
        hn::LoadInterleaved4(tag, lights + 4 * v, red, green, blue, alpha);
        const auto isSeen = hn::Gt(alpha, hn::Zero(tag));
        const V rest = hn::Add(hn::Sub(one, alpha), hn::Set(tag, LookLevels::kLeastRest));
        const V opacity = hn::Max(hn::Div(alpha, rest), hn::Set(tag, LookLevels::kLeast));
        const auto level =
            hn::ShiftRightSame(hn::Add(hn::BitCast(integers, opacity), below), dropped);
        hn::StoreU(
            hn::BitCast(numbers, hn::IfThenElseZero(hn::RebindMask(integers, isSeen), level)),
            numbers, opacities + v);
        const V perAlpha = hn::Div(one, hn::IfThenElse(isSeen, alpha, one));
        const auto shareOf = [&](V channel, int c) HWY_ATTR {
            const V share = hn::Mul(hn::Mul(channel, perAlpha),
                                    hn::Set(tag, levels.perLargest[std::size_t(c)]));
            const V root = hn::Sqrt(hn::Min(hn::Max(share, hn::Zero(tag)), one));
            return hn::ConvertTo(integers, hn::Add(hn::Mul(root, steps), threshold));
        };
        auto key = shareOf(red, 0);
        key = hn::Or(hn::ShiftLeftSame(key, levels.colorBits), shareOf(green, 1));
        key = hn::Or(hn::ShiftLeftSame(key, levels.colorBits), shareOf(blue, 2));
        hn::StoreU(hn::BitCast(numbers, key), numbers, colors + v);
    }
}

// Numbers eight voxels with no class or a single one. Returns the mask of the others.
// @param aloneClasses  if 0, all visible voxels are others
HWY_INLINE unsigned numberAlone(const JoinedRows& rows, std::size_t first,
                                std::uint16_t aloneClasses, ClassIndex* HWY_RESTRICT out) {
    const hn::CappedTag<std::uint16_t, 8> tag;
    unsigned others = 0;
    for (std::size_t v = 0; v < 8; v += hn::Lanes(tag)) {
        auto seen = hn::LoadU(tag, rows.slices[0] + first + v);
        for (std::size_t slice = 1; slice < rows.count; ++slice)
            seen = hn::Max(seen, hn::LoadU(tag, rows.slices[slice] + first + v));
        auto isOther = hn::FirstN(tag, 0);
        auto number = hn::Zero(tag);
        for (std::size_t slice = 0; slice < rows.count; ++slice) {
            const auto one = hn::LoadU(tag, rows.slices[slice] + first + v);
            const auto isSame = hn::Eq(one, seen);
            isOther = hn::Or(isOther, hn::Not(hn::Or(isSame, hn::Eq(one, hn::Zero(tag)))));
            number = hn::Add(number, hn::IfThenElseZero(isSame, hn::Set(tag, aloneClasses)));
        }
        const auto isSeen = hn::Ne(seen, hn::Zero(tag));
        if (aloneClasses == 0) {
            isOther = isSeen;
            number = hn::Zero(tag);
        } else {
            // The number depends on how often the class occurs.
            number = hn::Add(hn::Sub(number, hn::Set(tag, aloneClasses)), seen);
        }
        hn::StoreU(hn::IfThenElseZero(isSeen, number), tag, out + v);
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(tag, isOther, bits);
        others |= unsigned(bits[0]) << v;
    }
    return others;
}

// Returns the light of a voxel, or of two neighbours if the vector has room.
template <class D>
HWY_INLINE hn::Vec<D> lightsOf(D tag, const float* lights, const ClassIndex* classes) {
    if constexpr (hn::MaxLanes(D()) == 4) {
        return hn::LoadU(tag, lights + 4 * std::size_t(classes[0]));
    } else {
        const hn::Half<D> half;
        return hn::Combine(tag, hn::LoadU(half, lights + 4 * std::size_t(classes[1])),
                           hn::LoadU(half, lights + 4 * std::size_t(classes[0])));
    }
}

// Joins the slices of eight voxels, nearest first; at once, because each step waits for the last.
// @param rows  indices into `lights`: classes or pairs
// @param out   [8][4]
HWY_INLINE void joinRow(const JoinedRows& rows, const float* lights, std::size_t first,
                        float* HWY_RESTRICT out) {
    const hn::CappedTag<float, 8> tag;
    using V = hn::Vec<decltype(tag)>;
    constexpr std::size_t kVoxels = hn::MaxLanes(decltype(tag)()) / 4;  // per vector
    const V one = hn::Set(tag, 1.0F);
    const auto lightOf = [&](std::size_t slice, std::size_t v) HWY_ATTR {
        return lightsOf(tag, lights, rows.slices[slice] + first + v);
    };
    for (std::size_t half = 0; half < 8; half += 4 * kVoxels) {
        V a = lightOf(0, half);
        V b = lightOf(0, half + kVoxels);
        V c = lightOf(0, half + 2 * kVoxels);
        V d = lightOf(0, half + 3 * kVoxels);
        const auto add = [&](V& light, std::size_t slice, std::size_t v) HWY_ATTR {
            const V through = hn::Sub(one, hn::Broadcast<3>(light));
            light = hn::Add(light, hn::Mul(through, lightOf(slice, v)));
        };
        for (std::size_t slice = 1; slice < rows.count; ++slice) {
            add(a, slice, half);
            add(b, slice, half + kVoxels);
            add(c, slice, half + 2 * kVoxels);
            add(d, slice, half + 3 * kVoxels);
        }
        hn::Store(a, tag, out + 4 * half);
        hn::Store(b, tag, out + 4 * (half + kVoxels));
        hn::Store(c, tag, out + 4 * (half + 2 * kVoxels));
        hn::Store(d, tag, out + 4 * (half + 3 * kVoxels));
    }
}

// Like joinRow for classes, by pairs of slices if possible. Returns whether any voxel is visible.
HWY_INLINE bool joinClasses(const JoinedRows& rows, const LookLevels& levels, std::size_t first,
                            float* HWY_RESTRICT out) {
    HWY_ALIGN ClassIndex pairs[4 * kMostJoined];  // [pair][v]
    std::array<const ClassIndex*, kMostJoined> seen;
    std::size_t count = 0;
    for (std::size_t i = 0; i < rows.count; i += 2) {
        if (!anyClass({rows.slices + i, 2, rows.pitch}, first)) continue;
        const ClassIndex* const nearer = rows.slices[i] + first;
        const ClassIndex* const farther = rows.slices[i + 1] + first;
        if (levels.pairs) {
            ClassIndex* const pair = pairs + 8 * count;
            numberPairs(nearer, farther, levels.classCount, pair);
            seen[count++] = pair;
        } else {
            seen[count++] = nearer;
            seen[count++] = farther;
        }
    }
    if (count == 0) return false;
    joinRow({seen.data(), count, 8}, levels.pairs ? levels.pairs : levels.lights, 0, out);
    return true;
}

void joinLooksKernel(const JoinedRows& rows, const LookLevels& levels, LookKeys& keys) {
    for (std::size_t u = 0; u < 8; ++u) {
        const std::size_t first = u * rows.pitch;
        const unsigned others = numberAlone(rows, first, levels.aloneClasses, &keys.alone[8 * u]);
        keys.others[u] = std::uint8_t(others);
        if (others == 0) continue;
        HWY_ALIGN float lights[8 * 4];
        joinClasses(rows, levels, first, lights);
        roundLooks(levels, lights, levels.thresholds + 8 * u, &keys.opacities[8 * u],
                   &keys.colors[8 * u]);
    }
}

// Adds `within` rows of voxels to the sums of eight squares. Returns whether any voxel is visible.
// @param sums  [8][4]
HWY_INLINE bool addSquares(const JoinedRows& rows, const LookLevels& levels, std::size_t first,
                           std::size_t within, float* HWY_RESTRICT sums) {
    const hn::FixedTag<float, 4> tag;
    bool isSeen = false;
    for (std::size_t row = 0; row < within; ++row) {
        for (std::size_t v = 0; v < 8 * within; v += 8) {
            HWY_ALIGN float lights[8 * 4];
            if (!joinClasses(rows, levels, first + row * rows.pitch + v, lights)) continue;
            isSeen = true;
            for (std::size_t i = 0; i < 8; ++i) {
                float* const sum = sums + 4 * ((v + i) / within);
                hn::Store(hn::Add(hn::Load(tag, sum), hn::Load(tag, lights + 4 * i)), tag, sum);
            }
        }
    }
    return isSeen;
}

// Joins squares of voxels to their mean look.
void joinSquaresKernel(const JoinedRows& rows, const LookLevels& levels, std::size_t within,
                       LookKeys& keys) {
    const hn::FixedTag<float, 4> tag;
    const auto share = hn::Set(tag, 1.0F / float(within * within));
    keys.alone = {};
    for (std::size_t u = 0; u < 8; ++u) {
        HWY_ALIGN float means[8 * 4] = {};
        keys.others[u] = 0;
        if (!addSquares(rows, levels, u * within * rows.pitch, within, means)) continue;
        keys.others[u] = 0xFF;
        for (std::size_t i = 0; i < 8 * 4; i += 4)
            hn::Store(hn::Mul(hn::Load(tag, means + i), share), tag, means + i);
        roundLooks(levels, means, levels.thresholds + 8 * u, &keys.opacities[8 * u],
                   &keys.colors[8 * u]);
    }
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {
namespace {

HWY_EXPORT(joinLooksKernel);
HWY_EXPORT(joinSquaresKernel);

using Thresholds = std::array<float, 64>;  // of a slice, [u][v]

// Thresholds for few levels, [slice] of a block. Neighbours round up or down in proportion, so that
// even areas keep their mean (squares of roots: slightly more).
std::array<Thresholds, 8> spreadThresholds() {
    // Powers of 1 / x with x^4 = x + 1: a lattice that is even in three dimensions.
    constexpr std::array<double, 3> kSteps{0.81917251339616444, 0.67104360670378923,
                                           0.54970047790197024};
    std::array<Thresholds, 8> all;
    for (std::size_t i = 0; i < 512; ++i) {
        const std::array<std::size_t, 3> place{i / 64, i / 8 % 8, i % 8};
        double sum = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) sum += double(place[axis]) * kSteps[axis];
        all[i / 64][i % 64] = float(sum - std::floor(sum));
    }
    return all;
}

const float* thresholdsOf(int bits, std::size_t slice) {
    alignas(64) static const std::array<Thresholds, 8> spread = spreadThresholds();
    alignas(64) static const Thresholds nearest = [] {
        Thresholds halves;
        halves.fill(0.5F);
        return halves;
    }();
    return bits == LookRun::kMostBits ? nearest.data() : spread[slice].data();
}

std::shared_ptr<LookPalette> paletteBesides(std::size_t alone) {
    return std::make_shared<LookPalette>(std::numeric_limits<ClassIndex>::max() - alone);
}

}  // namespace

LookJoiner::LookJoiner(const std::vector<glm::dvec4>& lights, const LookRun& run)
    : run_(run), lights_(lights) {
    for (const glm::dvec4& light : lights) {
        rounded_.push_back({float(light.r), float(light.g), float(light.b), float(light.a)});
        for (int c = 0; c < 3 && light.a > 0; ++c)
            largest_[c] = std::max(largest_[c], light[c] / light.a);
    }
    for (int c = 0; c < 3; ++c)
        perLargest_[std::size_t(c)] = largest_[c] > 0 ? float(1 / largest_[c]) : 0;
    constexpr std::size_t kMostPaired = 256;
    if (rounded_.size() <= kMostPaired) joinPairs();
    const std::size_t alone = std::size_t(run.slices) * (lights.size() - 1);
    constexpr std::size_t kMostAlone = 32768;
    if (alone <= kMostAlone && run.within == 1) aloneClasses_ = lights.size() - 1;
    palette_ = paletteBesides(std::size_t(run.slices) * aloneClasses_);
}

// Halves the number of joins per voxel.
void LookJoiner::joinPairs() {
    std::vector<Rgba> pairs;
    pairs.reserve(rounded_.size() * rounded_.size());
    for (const Rgba& nearer : rounded_) {
        for (const Rgba& farther : rounded_) {
            Rgba& pair = pairs.emplace_back(nearer);
            for (std::size_t c = 0; c < 4; ++c) pair[c] += (1 - nearer[3]) * farther[c];
        }
    }
    pairs_ = std::make_shared<const std::vector<Rgba>>(std::move(pairs));
}

LookJoiner LookJoiner::coarser() const {
    LookJoiner other = *this;
    --other.run_.bits;
    other.palette_ = paletteBesides(std::size_t(run_.slices) * aloneClasses_);
    return other;
}

void LookJoiner::beginSample() const {
    if (palette_->count() == 0) palette_->limitTo(1.0 / 3);
}

void LookJoiner::endSample(std::size_t ofHalf) const {
    // Means are more varied, and a sixteenth of the volume may show few of them.
    const bool mayForesee =
        palette_->isLimited() && ofHalf > 0 && run_.within > 1 && run_.bits > LookRun::kLeastBits;
    const auto found = double(palette_->count());
    const double growth = mayForesee ? std::min(found / double(ofHalf), 2.0) : 1;
    // The whole doubles the sample four times. A margin avoids joining everything twice.
    constexpr double kMargin = 1.33;
    const double expected = kMargin * found * growth * growth * growth * growth;
    palette_->limitTo(mayForesee && expected > double(palette_->most()) ? 0 : 1);
}

std::vector<glm::dvec4> LookJoiner::looks() const {
    std::vector<glm::dvec4> looks(1);
    for (int times = 1; times <= run_.slices; ++times) {
        for (std::size_t i = 1; i <= aloneClasses_; ++i) {
            const glm::dvec4& light = lights_[i];
            if (!(light.a > 0)) {
                looks.emplace_back(0.0);
                continue;
            }
            const double alpha =
                light.a < 1 ? -portable::expm1(times * portable::log1p(-light.a)) : 1;
            looks.emplace_back(glm::dvec3(light) / light.a, alpha);
        }
    }
    const std::uint64_t mostLevel = (std::uint64_t{1} << run_.bits) - 1;
    const int dropped = LookLevels::kMantissaBits - opacityBits();
    for (const std::uint64_t key : palette_->keys()) {
        glm::dvec4& look = looks.emplace_back();
        for (int c = 0; c < 3; ++c) {
            const std::uint64_t level = key >> (run_.bits * (2 - c)) & mostLevel;
            const double root = double(level) / double(mostLevel);
            look[c] = root * root * largest_[c];
        }
        const double x = std::bit_cast<float>(std::uint32_t(key >> 32) << dropped);
        look.a = std::min(x * (1 + double(LookLevels::kLeastRest)) / (1 + x), 1.0);
    }
    return looks;
}

void LookJoiner::join(std::span<const ClassIndex* const> slices, std::size_t pitch,
                      std::size_t slice, ClassIndex* out, LookCache& cache) const {
    std::array<const ClassIndex*, kMostJoined> fromFront;
    std::copy(slices.begin(), slices.end(), fromFront.begin());
    if (run_.lastInFront)
        std::reverse(fromFront.begin(), fromFront.begin() + std::ptrdiff_t(slices.size()));
    const LookLevels levels{rounded_.front().data(),
                            pairs_ ? pairs_->front().data() : nullptr,
                            rounded_.size(),
                            perLargest_,
                            opacityBits(),
                            run_.bits,
                            thresholdsOf(run_.bits, slice),
                            std::uint16_t(aloneClasses_)};
    LookKeys keys;
    const JoinedRows rows{fromFront.data(), slices.size(), pitch};
    if (run_.within > 1) {
        HWY_DYNAMIC_DISPATCH(joinSquaresKernel)(rows, levels, std::size_t(run_.within), keys);
    } else {
        HWY_DYNAMIC_DISPATCH(joinLooksKernel)(rows, levels, keys);
    }
    std::copy(keys.alone.begin(), keys.alone.end(), out);
    const std::size_t first = std::size_t(run_.slices) * aloneClasses_;
    for (std::size_t u = 0; u < 8; ++u) {
        for (unsigned rest = keys.others[u]; rest != 0; rest &= rest - 1) {
            const std::size_t i = 8 * u + std::size_t(std::countr_zero(rest));
            const std::uint64_t opacity = keys.opacities[i];
            if (opacity == 0) continue;  // not visible
            const std::size_t number = cache.numberOf(opacity << 32 | keys.colors[i], *palette_);
            out[i] = number == 0 ? ClassIndex{0} : ClassIndex(first + number);
        }
    }
}

}  // namespace deltasplat
#endif
