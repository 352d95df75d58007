// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9, and Lee Westover, "Footprint Evaluation for Volume Rendering", 1990, for the sheet.
// Deviates in that footprints of at most 3x3 pixels are not stamped one by one: the tiles that
// changed voxels reach are summed anew from the colours shown, which gives the same integers.
#include "splat/splatter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <vector>

#include "hwy/cache_control.h"
#include "splat/tile_kernels.h"

namespace deltasplat {
namespace {

constexpr std::array<ClassIndex, 64> kEmptyClasses{};

// Returns a mask word of the voxels of a block that lie in the (slice, u, v) box.
std::uint64_t voxelsInBox(const IndexBox& box, glm::ivec2 block) {
    std::uint64_t word = 0;
    for (int n = 0; n < 64; ++n) {
        const int u = 8 * block.x + (n >> 3);
        const int v = 8 * block.y + (n & 7);
        const bool inside = u >= box.min.y && u <= box.max.y && v >= box.min.z && v <= box.max.z;
        word |= std::uint64_t{inside} << n;
    }
    return word;
}

}  // namespace

// What both ways of splatting share: which words a slice has, and which pixels they reach.
class Splatter::Kernel {
  public:
    Kernel(const SplatInput& input, const SheetLayout& largest)
        : input_(input), layout_(largest), sheet_(largest) {}
    virtual ~Kernel() = default;

    void run(const Slab& slab, const SheetLayout& layout,
             const std::function<void(int, const Sheet&)>& eachSlice) {
        layout_ = layout;
        sheet_.setLayout(layout);
        for (int slice = slab.firstSlice; slice < slab.firstSlice + slab.sliceCount; ++slice) {
            splatSlice(slice, slab.whole);
            eachSlice(slice, sheet_);
        }
        clear();
    }

  protected:
    virtual void splatSlice(int slice, bool whole) = 0;
    // Makes everything as it was before the first slice.
    virtual void clear() = 0;

    // Calls use(block, stamped voxels, classes) for the blocks of a slice that have something to
    // stamp.
    template <typename Use>
    void forBlocks(int slice, bool whole, const Use& use) {
        const std::span<const DeltaWord> words = wordsOf(slice);
        if (input_.stampEmptyVoxels) return forAllBlocks(words, use);
        for (const DeltaWord& word : words) {
            prefetchClasses(&word, words);
            const std::uint64_t active = whole ? word.visible : word.changed;
            use(blockOf(word), active, word.classes);
        }
    }

    std::size_t placeOf(glm::ivec2 block) const {
        return std::size_t(block.y) * layout_.blocks.x + block.x;
    }
    std::size_t blockCount() const { return std::size_t(layout_.blocks.x) * layout_.blocks.y; }

    // Tells the sheet which pixels the voxels of a mask word reach.
    void touchBlock(glm::ivec2 block, std::uint64_t word) {
        const int firstU = std::countr_zero(word) >> 3;
        const int lastU = (63 - std::countl_zero(word)) >> 3;
        word |= word >> 32;
        word |= word >> 16;
        word |= word >> 8;
        const auto columns = std::uint8_t(word);
        const int firstV = std::countr_zero(columns);
        const int lastV = 7 - std::countl_zero(columns);
        const SheetLayout& layout = layout_;
        const glm::ivec2 origin =
            8 * layout.resolution * block + layout.marginPixels - layout.reachPixels;
        sheet_.touch(
            origin + layout.resolution * glm::ivec2(firstV, firstU),
            origin + layout.resolution * glm::ivec2(lastV, lastU) + input_.footprint.width - 1);
    }

    const SplatInput& input_;
    SheetLayout layout_;
    Sheet sheet_;

  private:
    // The words of a slice whose blocks the layout has; they are ordered by u.
    std::span<const DeltaWord> wordsOf(int slice) const {
        const std::span<const DeltaWord> words = input_.deltas.slice(slice);
        const int firstU = layout_.firstVoxel.y / 8;
        const auto before = [](const DeltaWord& word, int u) { return word.block.x < u; };
        const auto first = std::lower_bound(words.begin(), words.end(), firstU, before);
        return {first, std::lower_bound(first, words.end(), firstU + layout_.blocks.y, before)};
    }

    // The words of a slice lie in order, but not what they point to.
    static void prefetchClasses(const DeltaWord* word, std::span<const DeltaWord> words) {
        constexpr std::ptrdiff_t kAhead = 8;
        if (words.data() + words.size() - word <= kAhead) return;
        hwy::Prefetch(word[kAhead].classes);
        hwy::Prefetch(word[kAhead].classes + 32);
    }

    // Sheets run along v.
    glm::ivec2 firstBlock() const { return layout_.firstVoxel / 8; }
    glm::ivec2 blockOf(const DeltaWord& word) const {
        return glm::ivec2(word.block.y, word.block.x) - firstBlock();
    }

    template <typename Use>
    void forAllBlocks(std::span<const DeltaWord> words, const Use& use) {
        auto word = words.begin();
        for (int u = 0; u < layout_.blocks.y; ++u) {
            for (int v = 0; v < layout_.blocks.x; ++v) {
                const ClassIndex* classes = kEmptyClasses.data();
                if (word != words.end() && blockOf(*word) == glm::ivec2(v, u)) {
                    classes = word->classes;
                    ++word;
                }
                const std::uint64_t active =
                    voxelsInBox(input_.deltas.box,
                                glm::ivec2(firstBlock().y, firstBlock().x) + glm::ivec2(u, v));
                use(glm::ivec2(v, u), active, classes);
            }
        }
    }
};

namespace {

// Stamps footprints one by one.
class StampKernel : public Splatter::Kernel {
  public:
    StampKernel(const SplatInput& input, const SheetLayout& largest)
        : Kernel(input, largest),
          mostBlocks_(blockCount()),
          weights_(input.footprint, largest.channels) {
        for (int n = 0; n < 64; ++n) {
            const std::size_t pixels = std::size_t(n >> 3) * largest.pitchPixels() + (n & 7);
            placeInBlock_[n] = std::uint32_t(pixels * largest.resolution);
        }
    }

  private:
    void splatSlice(int slice, bool whole) override {
        if (whole) {
            sheet_.clear();
        } else if (shown_.empty()) {
            shown_.resize(64 * mostBlocks_);
        }
        const ClassTable::Color* colors = input_.classes.colors.data();
        forBlocks(slice, whole,
                  [&](glm::ivec2 block, std::uint64_t active, const ClassIndex* classes) {
                      if (list_.count + 64 > StampList::kCapacity) flush();
                      touchBlock(block, active);
                      const SheetLayout& layout = layout_;
                      const std::size_t place = layout.stampPlace(layout.firstVoxel + 8 * block);
                      const BlockSlice voxels{classes, active, std::uint32_t(place),
                                              placeInBlock_.data()};
                      if (whole) {
                          listWhole(voxels, colors, list_);
                      } else {
                          listChanges(voxels, colors, &shown_[64 * placeOf(block)], list_);
                      }
                  });
        flush();
        sheet_.settle();
    }

    void flush() { addStamps(sheet_.pixels(), sheet_.pitch(), weights_, list_); }

    void clear() override {
        sheet_.clear();
        std::fill(shown_.begin(), shown_.end(), ClassIndex{kEmptySlot});
    }

    std::size_t mostBlocks_;  // of any layout
    StampWeights weights_;
    std::array<std::uint32_t, 64>
        placeInBlock_;               // of a voxel's footprint, from its block's first one
    std::vector<ClassIndex> shown_;  // [block][64], of slabs that are not whole
    StampList list_;
};

// Sums up whole tiles of small footprints.
class TileKernel : public Splatter::Kernel {
  public:
    TileKernel(const SplatInput& input, const SheetLayout& largest)
        : Kernel(input, largest),
          weights_(input.footprint, largest.channels),
          pitch_(largest.channels * (largest.pitchPixels() / largest.resolution)),
          plane_(pitch_ * (largest.sizePixels.y / largest.resolution)),
          shown_(blockCount()) {}

  private:
    // What the plane shows of a block.
    struct Shown {
        std::uint64_t voxels = 0;  // that may not be empty
        int slice = 0;             // that last painted it, in a slab that is whole
    };

    void splatSlice(int slice, bool whole) override {
        if (whole) {
            paintWhole(slice);
        } else {
            paintChanges(slice);
        }
        sheet_.refillTouched(
            [&](int row, std::span<const std::uint8_t> touched, std::span<std::uint8_t> full) {
                splatTiles(weights_,
                           {planeAt({0, kTilePixels * row / layout_.resolution}), pitch_,
                            sheet_.tile(row, 0), sheet_.pitch()},
                           touched, full);
            });
    }

    void paintChanges(int slice) {
        forBlocks(slice, false,
                  [&](glm::ivec2 block, std::uint64_t active, const ClassIndex* classes) {
                      Shown& shown = shown_[placeOf(block)];
                      if (shown.voxels == 0) shownBlocks_.push_back(block);
                      shown.voxels |= active;
                      paint(block, active, classes);
                  });
    }

    // Only what the slice before showed and this one does not paint over has to be taken away.
    void paintWhole(int slice) {
        before_.swap(shownBlocks_);
        shownBlocks_.clear();
        forBlocks(slice, true,
                  [&](glm::ivec2 block, std::uint64_t active, const ClassIndex* classes) {
                      Shown& shown = shown_[placeOf(block)];
                      paint(block, active | shown.voxels, classes);
                      shown = {active, slice};
                      shownBlocks_.push_back(block);
                  });
        for (const glm::ivec2 block : before_) {
            if (shown_[placeOf(block)].slice != slice) takeAway(block);
        }
    }

    void takeAway(glm::ivec2 block) {
        Shown& shown = shown_[placeOf(block)];
        paint(block, shown.voxels, kEmptyClasses.data());
        shown.voxels = 0;
    }

    // Writes the colours of voxels of a block.
    void paint(glm::ivec2 block, std::uint64_t voxels, const ClassIndex* classes) {
        touchBlock(block, voxels);
        std::int16_t* first = planeAt(8 * block + layout_.marginPixels / layout_.resolution);
        if (layout_.channels == 4) {
            paintColors(first, voxels, classes);
        } else {
            paintOpacities(first, classes);
        }
    }

    void paintColors(std::int16_t* plane, std::uint64_t voxels, const ClassIndex* classes) const {
        const ClassTable::Color* colors = input_.classes.colors.data();
        // Where most voxels change, it is faster to write all.
        constexpr int kFew = 24;
        if (std::popcount(voxels) >= kFew) {
            for (int u = 0; u < 8; ++u, plane += pitch_) {
                for (int v = 0; v < 8; ++v)
                    std::memcpy(plane + 4 * v, &colors[*classes++], sizeof *colors);
            }
            return;
        }
        for (std::uint64_t rest = voxels; rest != 0; rest &= rest - 1) {
            const int n = std::countr_zero(rest);
            std::memcpy(plane + (n >> 3) * pitch_ + 4 * (n & 7), &colors[classes[n]],
                        sizeof *colors);
        }
    }

    // Of one colour, a class's number is its opacity.
    void paintOpacities(std::int16_t* plane, const ClassIndex* classes) const {
        static_assert(sizeof *plane == sizeof *classes);
        for (int u = 0; u < 8; ++u, plane += pitch_, classes += 8) {
            std::memcpy(plane, classes, 8 * sizeof *classes);
        }
    }

    std::int16_t* planeAt(glm::ivec2 voxel) {
        return &plane_[pitch_ * voxel.y + std::size_t(layout_.channels) * voxel.x];
    }

    void clear() override {
        for (const glm::ivec2 block : shownBlocks_) takeAway(block);
        shownBlocks_.clear();
        sheet_.clear();
    }

    TileWeights weights_;
    std::size_t pitch_;                    // of the plane
    std::vector<std::int16_t> plane_;      // colours shown, a margin around them as in the sheet
    std::vector<Shown> shown_;             // [block]
    std::vector<glm::ivec2> shownBlocks_;  // those with voxels
    std::vector<glm::ivec2> before_;       // likewise, in the slice before
};

}  // namespace

Splatter::Splatter(const SplatInput& input, const SheetLayout& largest) {
    if (TileWeights::fits(input.footprint)) {
        kernel_ = std::make_unique<TileKernel>(input, largest);
    } else {
        kernel_ = std::make_unique<StampKernel>(input, largest);
    }
}

Splatter::~Splatter() = default;

void Splatter::run(const Slab& slab, const SheetLayout& layout,
                   const std::function<void(int, const Sheet&)>& eachSlice) {
    kernel_->run(slab, layout, eachSlice);
}

double Splatter::bytes(const SheetLayout& layout) {
    // The sheet, and what is shown: half the sheet's size at most, or 8 bytes a voxel.
    const double voxels = 64.0 * layout.blocks.x * layout.blocks.y;
    return 1.5 * double(layout.bytes()) + (8 + 0.25) * voxels;
}

}  // namespace deltasplat
