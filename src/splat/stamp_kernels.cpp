// SPDX-License-Identifier: Apache-2.0
// The inner loops of splatting stamp by stamp, compiled once for each SIMD level. All of it is
// integer arithmetic, so that every level gives the same bits.
#include "splat/stamp_kernels.h"

#include <bit>
#include <cstring>

#include "bit_matrix.h"
#include "simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splat/stamp_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Wider vectors are slower here: consecutive stamps overlap, and what was just stored can only be
// forwarded to a load of the same place and width.
constexpr std::size_t kMaxLanes = 8;
using IntTag = hn::CappedTag<std::int32_t, kMaxLanes>;

// A class's colour as stamps multiply it: for every pixel of a vector, in 16-bit integers.
template <int kChannels>
HWY_INLINE auto loadColor(const ClassTable::Color& color) {
    const hn::Rebind<std::int16_t, IntTag> tag;
    if constexpr (kChannels == 4) {
        std::uint64_t bits;
        static_assert(sizeof bits == sizeof color);
        std::memcpy(&bits, color.data(), sizeof bits);
        return hn::BitCast(tag, hn::Set(hn::Repartition<std::uint64_t, decltype(tag)>(), bits));
    } else {
        return hn::Set(tag, color[3]);
    }
}

// Rows of a footprint as vectors: in registers where the width is known at compile time and small,
// for a stamp is bound by its loads and stores.
template <int kChannels, int kWidth>
class Rows {
    static constexpr int kLanes = int(hn::MaxLanes(IntTag()));
    static constexpr int kVectors = (kWidth * kChannels + kLanes - 1) / kLanes;

  public:
    explicit Rows(const StampWeights& weights) {
        for (int y = 0; y < kWidth; ++y) {
            for (int x = 0; x < kVectors; ++x) {
                held_[y][x] =
                    hn::LoadU(IntTag(), &weights.weights[y * weights.rowLength + x * kLanes]);
            }
        }
    }

    // Adds color * weight to the pixels from `row` on.
    HWY_INLINE void stamp(hn::Vec<IntTag> color, std::int32_t* HWY_RESTRICT row,
                          std::size_t pitch) const {
        const IntTag tag;
        for (int y = 0; y < kWidth; ++y, row += pitch) {
            for (int x = 0; x < kVectors; ++x) {
                const auto sum = hn::LoadU(tag, row + x * kLanes);
                hn::StoreU(hn::Add(sum, hn::Mul(color, held_[y][x])), tag, row + x * kLanes);
            }
        }
    }

  private:
    hn::Vec<IntTag> held_[kWidth][kVectors];
};

// Of any width.
template <int kChannels>
class Rows<kChannels, 0> {
  public:
    explicit Rows(const StampWeights& weights)
        : table_(weights.weights.data()), rowLength_(weights.rowLength), rows_(weights.rows) {}

    HWY_INLINE void stamp(hn::Vec<IntTag> color, std::int32_t* HWY_RESTRICT row,
                          std::size_t pitch) const {
        const IntTag tag;
        const std::int32_t* HWY_RESTRICT weights = table_;
        for (int y = 0; y < rows_; ++y, row += pitch, weights += rowLength_) {
            for (std::size_t x = 0; x < rowLength_; x += hn::Lanes(tag)) {
                const auto sum = hn::LoadU(tag, row + x);
                const auto product = hn::Mul(color, hn::LoadU(tag, weights + x));
                hn::StoreU(hn::Add(sum, product), tag, row + x);
            }
        }
    }

  private:
    const std::int32_t* table_;
    std::size_t rowLength_;
    int rows_;
};

// Calls use(n) for the active voxels of a slice, along u first: that is down the rows of the sheet,
// where consecutive stamps meet the very vectors that were just stored.
template <typename Use>
HWY_INLINE void forActive(std::uint64_t active, const Use& use) {
    for (std::uint64_t rest = transposedBits(active); rest != 0; rest &= rest - 1) {
        const int n = std::countr_zero(rest);
        use(8 * (n & 7) + (n >> 3));
    }
}

template <int kChannels, int kWidth>
void stampBlockOf(const BlockSlice& slice, const ClassTable::Color* HWY_RESTRICT colors,
                  std::uint16_t* HWY_RESTRICT shown, const StampWeights& weights,
                  const StampTarget& target) {
    const Rows<kChannels, kWidth> rows(weights);
    const auto stamp = [&](int n, auto color) HWY_ATTR {
        rows.stamp(hn::PromoteTo(IntTag(), color),
                   target.first + std::size_t(kChannels) * slice.placeInBlock[n], target.pitch);
    };
    if (shown == nullptr) {
        forActive(slice.active, [&](int n) HWY_ATTR {
            stamp(n, loadColor<kChannels>(colors[slice.classes[n]]));
        });
        return;
    }
    forActive(slice.active, [&](int n) HWY_ATTR {
        const auto before = loadColor<kChannels>(colors[shown[n]]);
        shown[n] = slice.classes[n];
        stamp(n, hn::Sub(loadColor<kChannels>(colors[shown[n]]), before));
    });
}

template <int kChannels>
void stampBlockIn(const BlockSlice& slice, const ClassTable::Color* colors, std::uint16_t* shown,
                  const StampWeights& weights, const StampTarget& target) {
    switch (weights.rows) {
        case 3:
            return stampBlockOf<kChannels, 3>(slice, colors, shown, weights, target);
        case 4:
            return stampBlockOf<kChannels, 4>(slice, colors, shown, weights, target);
        case 5:
            return stampBlockOf<kChannels, 5>(slice, colors, shown, weights, target);
        case 6:
            return stampBlockOf<kChannels, 6>(slice, colors, shown, weights, target);
        case 7:
            return stampBlockOf<kChannels, 7>(slice, colors, shown, weights, target);
        default:
            return stampBlockOf<kChannels, 0>(slice, colors, shown, weights, target);
    }
}

void stampBlockKernel(const BlockSlice& slice, const ClassTable::Color* colors,
                      std::uint16_t* shown, const StampWeights& weights,
                      const StampTarget& target) {
    return weights.channels == 4 ? stampBlockIn<4>(slice, colors, shown, weights, target)
                                 : stampBlockIn<1>(slice, colors, shown, weights, target);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(stampBlockKernel);

StampWeights::StampWeights(const Footprint& footprint, int sheetChannels)
    : channels(sheetChannels),
      rows(footprint.width),
      // The widest vectors have eight lanes.
      rowLength((std::size_t(footprint.width) * sheetChannels + 7) / 8 * 8),
      weights(rows * rowLength) {
    for (int y = 0; y < rows; ++y) {
        for (int i = 0; i < rows * channels; ++i) {
            weights[y * rowLength + i] = footprint.at(i / channels, y);
        }
    }
}

void stampWhole(const BlockSlice& slice, const ClassTable::Color* colors,
                const StampWeights& weights, const StampTarget& target) {
    HWY_DYNAMIC_DISPATCH(stampBlockKernel)(slice, colors, nullptr, weights, target);
}

void stampChanges(const BlockSlice& slice, const ClassTable::Color* colors, std::uint16_t* shown,
                  const StampWeights& weights, const StampTarget& target) {
    HWY_DYNAMIC_DISPATCH(stampBlockKernel)(slice, colors, shown, weights, target);
}

}  // namespace deltasplat
#endif
