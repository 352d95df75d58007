// SPDX-License-Identifier: Apache-2.0
// Mixing values; inner loops compiled once per SIMD level.
#include "words/mix_kernels.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "words/mix_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 8>;
using Ints = hn::RebindToSigned<Floats>;
using FloatVec = hn::Vec<Floats>;
using IntVec = hn::Vec<Ints>;

constexpr std::size_t kSide = MixWindow::kSide;
constexpr std::size_t kPlane = MixWindow::kPlane;
// Largest overrun of vectors beyond a row or a plane.
constexpr std::size_t kBeyond = 8;

// As mixed() in mix_window.h, with twice the share.
HWY_INLINE FloatVec mixedVector(FloatVec here, FloatVec other, FloatVec twice) {
    const FloatVec half = hn::Set(Floats(), 0.5f);
    const FloatVec difference = hn::Sub(hn::Mul(half, other), hn::Mul(half, here));
    const FloatVec step = hn::Mul(difference, twice);
    return hn::Add(here, hn::IfThenElseZero(hn::Eq(difference, difference), step));
}

// Maps steps above the lowest code to looks.
struct LevelLooks {
    FloatVec perCode;
    const Slot* slotMap;
    const float* opacities;

    HWY_INLINE IntVec levelsOf(FloatVec steps) const {
        const auto isThere = hn::Eq(steps, steps);
        const FloatVec some = hn::Mul(hn::IfThenElseZero(isThere, steps), perCode);
        const IntVec level = hn::ConvertTo(Ints(), hn::Add(some, hn::Set(Floats(), 0.5f)));
        return hn::IfThenElseZero(hn::RebindMask(Ints(), isThere),
                                  hn::Add(level, hn::Set(Ints(), 1)));
    }
    HWY_INLINE IntVec slotsOf(IntVec levels) const {
        return hn::GatherIndex(Ints(), slotMap, levels);
    }
    HWY_INLINE FloatVec opacitiesOf(IntVec levels) const {
        return hn::GatherIndex(Floats(), opacities, levels);
    }
};

// Largest opacity among the parts of each voxel.
struct MostOpacities {
    HWY_ALIGN float of[512] = {};

    // Notes the parts of the voxels in a row from `place` on.
    HWY_INLINE void note(const LevelLooks& looks, IntVec levels, std::size_t place) {
        const FloatVec known = hn::LoadU(Floats(), of + place);
        hn::StoreU(hn::Max(known, looks.opacitiesOf(levels)), Floats(), of + place);
    }
    HWY_INLINE FloatVec at(const LevelLooks&, std::size_t place) const {
        return hn::LoadU(Floats(), of + place);
    }
};

// The same if opacities rise with levels: keeps the highest level.
struct HighestLevels {
    HWY_ALIGN std::int32_t of[512] = {};

    HWY_INLINE void note(const LevelLooks&, IntVec levels, std::size_t place) {
        hn::StoreU(hn::Max(hn::LoadU(Ints(), of + place), levels), Ints(), of + place);
    }
    HWY_INLINE FloatVec at(const LevelLooks& looks, std::size_t place) const {
        return looks.opacitiesOf(hn::LoadU(Ints(), of + place));
    }
};

template <typename Most>
HWY_INLINE VoxelMasks mixLevels(const MixWindow& window, const Subdivision& parts,
                                const EvenLevels& levels, const LevelLooks& looks,
                                BlockSlots* mixed) {
    const std::size_t lanes = hn::Lanes(Floats());

    // Steps above the lowest code, or NaN. Floats hold quarters of quarters of 16 bits exactly.
    HWY_ALIGN float steps[kSide * kPlane + kBeyond];
    const IntVec first = hn::Set(Ints(), levels.lowest + 1);
    const FloatVec none = hn::Set(Floats(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t n = 0; n < window.slots.size(); n += lanes) {
        const IntVec slots = hn::LoadU(Ints(), window.slots.data() + n);
        const auto isEmpty = hn::RebindMask(Floats(), hn::Eq(slots, hn::Zero(Ints())));
        const FloatVec own = hn::ConvertTo(Floats(), hn::Sub(slots, first));
        hn::StoreU(hn::IfThenElse(isEmpty, none, own), Floats(), steps + n);
    }
    std::fill(std::end(steps) - kBeyond, std::end(steps), 0.0f);

    Most most;
    HWY_ALIGN float plane[kPlane + kBeyond] = {};
    HWY_ALIGN float row[kSide + kBeyond];
    HWY_ALIGN Slot thin[16];
    const FloatVec half = hn::Set(Floats(), 0.5f);
    const auto slices = std::size_t(parts.slices);
    const auto within = std::size_t(parts.within);
    for (std::size_t s = 0; s < 8 * slices; ++s) {
        // Distance from the voxel's centre, in halves of a thin slice.
        const int offset = 2 * int(s % slices) + 1 - parts.slices;
        const float* const here = steps + (1 + s / slices) * kPlane;
        const float* const other = offset < 0 ? here - kPlane : here + kPlane;
        const float share = float(std::abs(offset)) / float(2 * parts.slices);
        for (std::size_t n = 0; n < kPlane; n += lanes) {
            const FloatVec between =
                mixedVector(hn::LoadU(Floats(), here + n), hn::LoadU(Floats(), other + n),
                            hn::Set(Floats(), 2 * share));
            hn::StoreU(between, Floats(), plane + n);
        }
        for (std::size_t u = 0; u < 8 * within; ++u) {
            const std::size_t part = (u / 8 * slices + s / 8) * within;
            const std::size_t place = 64 * (s % 8) + 8 * (u % 8);
            const float* const own = plane + (1 + u / within) * kSide;
            const std::size_t voxels = 64 * (s / slices) + 8 * (u / within);
            if (within == 1) {
                for (std::size_t v = 0; v < 8; v += lanes) {
                    const IntVec level = looks.levelsOf(hn::LoadU(Floats(), own + 1 + v));
                    hn::StoreU(looks.slotsOf(level), Ints(), &mixed[part][place + v]);
                    most.note(looks, level, voxels + v);
                }
                continue;
            }
            const float* const beside = u % 2 == 0 ? own - kSide : own + kSide;
            for (std::size_t v = 0; v < kSide; v += lanes) {
                const FloatVec between = mixedVector(hn::LoadU(Floats(), own + v),
                                                     hn::LoadU(Floats(), beside + v), half);
                hn::StoreU(between, Floats(), row + v);
            }
            for (std::size_t v = 0; v < 8; v += lanes) {
                const FloatVec middle = hn::LoadU(Floats(), row + v + 1);
                const FloatVec before = hn::LoadU(Floats(), row + v);
                const FloatVec behind = hn::LoadU(Floats(), row + v + 2);
                const IntVec even = looks.levelsOf(mixedVector(middle, before, half));
                const IntVec odd = looks.levelsOf(mixedVector(middle, behind, half));
                hn::StoreInterleaved2(looks.slotsOf(even), looks.slotsOf(odd), Ints(),
                                      thin + 2 * v);
                most.note(looks, even, voxels + v);
                most.note(looks, odd, voxels + v);
            }
            std::copy_n(thin, 8, &mixed[part][place]);
            std::copy_n(thin + 8, 8, &mixed[part + 1][place]);
        }
    }

    VoxelMasks lost{};
    for (std::size_t n = 0; n < 512; n += lanes) {
        const std::size_t place = (1 + n / 64) * kPlane + (1 + n / 8 % 8) * kSide + 1 + n % 8;
        const FloatVec own = looks.opacitiesOf(looks.levelsOf(hn::LoadU(Floats(), steps + place)));
        const auto isLost = hn::Lt(most.at(looks, n), hn::Mul(half, own));
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(Floats(), isLost, bits);
        lost[n / 64] |= std::uint64_t(bits[0]) << n % 64;
    }
    return lost;
}

VoxelMasks mixEvenLevelsKernel(const MixWindow& window, const Subdivision& parts,
                               const EvenLevels& levels, const Slot* slotMap,
                               const float* opacities, bool rise, BlockSlots* mixed) {
    const LevelLooks looks{hn::Set(Floats(), float(levels.perCode)), slotMap, opacities};
    return rise ? mixLevels<HighestLevels>(window, parts, levels, looks, mixed)
                : mixLevels<MostOpacities>(window, parts, levels, looks, mixed);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(mixEvenLevelsKernel);

VoxelMasks mixEvenLevels(const MixWindow& window, const Subdivision& parts,
                         const EvenLevels& levels, const Slot* slotMap, const float* opacities,
                         bool rise, BlockSlots* mixed) {
    return HWY_DYNAMIC_DISPATCH(mixEvenLevelsKernel)(window, parts, levels, slotMap, opacities,
                                                     rise, mixed);
}

}  // namespace deltasplat
#endif
