// SPDX-License-Identifier: Apache-2.0
// The inner loops of splatting stamp by stamp, compiled once per SIMD level. Integer arithmetic
// gives the same bits at every level.
#include "splat/stamp_kernels.h"

#include <bit>
#include <cstring>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splat/stamp_kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "splat/pair_products-inl.h"

HWY_BEFORE_NAMESPACE();
namespace deltasplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Wider is slower: stamps overlap, and stores forward only to loads of their place and width.
constexpr std::size_t kMaxLanes = 8;
using IntTag = hn::CappedTag<std::int32_t, kMaxLanes>;

// A class's colour as 16-bit factors for every pixel of a vector.
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

// 16-bit integers, each before a zero: pairwise products cost half of 32-bit ones on x86.
template <class V>
HWY_INLINE hn::Vec<IntTag> asPairs(V values) {
    const hn::Rebind<std::uint16_t, IntTag> narrow;
    const hn::Rebind<std::uint32_t, IntTag> wide;
    return hn::BitCast(IntTag(), hn::PromoteTo(wide, hn::BitCast(narrow, values)));
}

// Rows of a footprint: in registers for small fixed widths, as loads and stores bound stamps.
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

    // Adds color * weight, `color` as pairs, to the pixels from `row` on.
    HWY_INLINE void stamp(hn::Vec<IntTag> color, std::int32_t* HWY_RESTRICT row,
                          std::size_t pitch) const {
        const IntTag tag;
        for (int y = 0; y < kWidth; ++y, row += pitch) {
            for (int x = 0; x < kVectors; ++x) {
                const auto sum = hn::LoadU(tag, row + x * kLanes);
                hn::StoreU(hn::Add(sum, productsOfPairs(tag, color, held_[y][x])), tag,
                           row + x * kLanes);
            }
        }
    }

  private:
    hn::Vec<IntTag> held_[kWidth][kVectors];
};

// Rows of any width.
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
                const auto added = productsOfPairs(tag, color, hn::LoadU(tag, weights + x));
                hn::StoreU(hn::Add(sum, added), tag, row + x);
            }
        }
    }

  private:
    const std::int32_t* table_;
    std::size_t rowLength_;
    int rows_;
};

// Iterates over the active voxels of blocks, first along u: down the rows of the sheet, where
// consecutive stamps meet just stored vectors.
template <class Stamps>
class ActiveVoxels {
  public:
    explicit ActiveVoxels(std::span<const Stamps> blocks)
        : block_(blocks.data()), last_(block_ + blocks.size() - 1), rest_(block_->byColumn) {}

    const Stamps& block() const { return *block_; }
    int voxel() const {
        const int n = std::countr_zero(rest_);
        return 8 * (n & 7) + (n >> 3);
    }
    // The last block's first voxel follows its last one again, so that loading ahead stays valid.
    void next() {
        rest_ &= rest_ - 1;
        if (rest_ != 0) return;
        if (block_ != last_) ++block_;
        rest_ = block_->byColumn;
    }

  private:
    const Stamps* block_;
    const Stamps* last_;
    std::uint64_t rest_;  // of the block's voxels
};

// The colours of a block's voxel now and before.
class ClassColors {
  public:
    explicit ClassColors(const ClassTable::Color* colors) : colors_(colors) {}
    HWY_INLINE const ClassTable::Color& of(const BlockStamps& block, int n) const {
        return colors_[block.classes[n]];
    }
    HWY_INLINE const ClassTable::Color& shown(const BlockStamps& block, int n) const {
        return colors_[block.shown[n]];
    }
    HWY_INLINE static void show(const BlockStamps& block, int n) {
        block.shown[n] = block.classes[n];
    }

  private:
    const ClassTable::Color* HWY_RESTRICT colors_;
};

struct OwnColors {
    HWY_INLINE static const ClassTable::Color& of(const ColorStamps& block, int n) {
        return block.colors[n];
    }
    HWY_INLINE static const ClassTable::Color& shown(const ColorStamps& block, int n) {
        return block.shown[n];
    }
    HWY_INLINE static void show(const ColorStamps& block, int n) {
        block.shown[n] = block.colors[n];
    }
};

template <int kChannels, int kWidth, bool kChanges, class Stamps, class Colors>
void stampBlocksOf(std::span<const Stamps> blocks, const Colors& colors,
                   const StampWeights& weights, const StampPlaces& places) {
    std::size_t count = 0;
    for (const Stamps& block : blocks) count += std::size_t(std::popcount(block.byColumn));
    const Rows<kChannels, kWidth> rows(weights);
    const std::size_t pitch = places.pitch;
    ActiveVoxels<Stamps> voxels(blocks);
    hn::Vec<IntTag> color;
    std::int32_t* row;
    // Colour and place are loaded one stamp ahead, so that no stamp waits for them.
    const auto load = [&]() HWY_ATTR {
        const Stamps& block = voxels.block();
        const int n = voxels.voxel();
        auto bits = loadColor<kChannels>(colors.of(block, n));
        if constexpr (kChanges) {
            bits = hn::Sub(bits, loadColor<kChannels>(colors.shown(block, n)));
            colors.show(block, n);
        }
        color = asPairs(bits);
        row = block.first + std::size_t(kChannels) * places.inBlock[n];
        voxels.next();
    };
    load();
    for (; count > 1; --count) {
        const auto thisColor = color;
        std::int32_t* thisRow = row;
        load();
        rows.stamp(thisColor, thisRow, pitch);
    }
    rows.stamp(color, row, pitch);
}

template <int kChannels, bool kChanges, class Stamps, class Colors>
void stampBlocksIn(std::span<const Stamps> blocks, const Colors& colors,
                   const StampWeights& weights, const StampPlaces& places) {
    switch (weights.rows) {
        case 3:
            return stampBlocksOf<kChannels, 3, kChanges>(blocks, colors, weights, places);
        case 4:
            return stampBlocksOf<kChannels, 4, kChanges>(blocks, colors, weights, places);
        case 5:
            return stampBlocksOf<kChannels, 5, kChanges>(blocks, colors, weights, places);
        case 6:
            return stampBlocksOf<kChannels, 6, kChanges>(blocks, colors, weights, places);
        case 7:
            return stampBlocksOf<kChannels, 7, kChanges>(blocks, colors, weights, places);
        default:
            return stampBlocksOf<kChannels, 0, kChanges>(blocks, colors, weights, places);
    }
}

void stampWholeKernel(std::span<const BlockStamps> blocks, const ClassTable::Color* colors,
                      const StampWeights& weights, const StampPlaces& places) {
    const ClassColors ofClasses(colors);
    return weights.channels == 4 ? stampBlocksIn<4, false>(blocks, ofClasses, weights, places)
                                 : stampBlocksIn<1, false>(blocks, ofClasses, weights, places);
}

void stampChangesKernel(std::span<const BlockStamps> blocks, const ClassTable::Color* colors,
                        const StampWeights& weights, const StampPlaces& places) {
    const ClassColors ofClasses(colors);
    return weights.channels == 4 ? stampBlocksIn<4, true>(blocks, ofClasses, weights, places)
                                 : stampBlocksIn<1, true>(blocks, ofClasses, weights, places);
}

void stampOwnKernel(std::span<const ColorStamps> blocks, bool changes, const StampWeights& weights,
                    const StampPlaces& places) {
    return changes ? stampBlocksIn<4, true>(blocks, OwnColors(), weights, places)
                   : stampBlocksIn<4, false>(blocks, OwnColors(), weights, places);
}

}  // namespace deltasplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltasplat {

HWY_EXPORT(stampWholeKernel);
HWY_EXPORT(stampChangesKernel);
HWY_EXPORT(stampOwnKernel);

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

void stampWhole(std::span<const BlockStamps> blocks, const ClassTable::Color* colors,
                const StampWeights& weights, const StampPlaces& places) {
    if (blocks.empty()) return;
    HWY_DYNAMIC_DISPATCH(stampWholeKernel)(blocks, colors, weights, places);
}

void stampChanges(std::span<const BlockStamps> blocks, const ClassTable::Color* colors,
                  const StampWeights& weights, const StampPlaces& places) {
    if (blocks.empty()) return;
    HWY_DYNAMIC_DISPATCH(stampChangesKernel)(blocks, colors, weights, places);
}

void stampWhole(std::span<const ColorStamps> blocks, const StampWeights& weights,
                const StampPlaces& places) {
    if (blocks.empty()) return;
    HWY_DYNAMIC_DISPATCH(stampOwnKernel)(blocks, false, weights, places);
}

void stampChanges(std::span<const ColorStamps> blocks, const StampWeights& weights,
                  const StampPlaces& places) {
    if (blocks.empty()) return;
    HWY_DYNAMIC_DISPATCH(stampOwnKernel)(blocks, true, weights, places);
}

}  // namespace deltasplat
#endif
