// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/view/factorization.h"
#include "volume/code_blocks.h"
#include "words/mix_kernels.h"
#include "words/mix_window.h"

namespace deltasplat {

struct MixMap {
    /// @param slotMap            [kSlotCount]: maps slots of levels; must outlive this object
    /// @param opacitiesOfMapped  [mapped slot]: of a voxel, above 0 if visible; empty: all equal
    MixMap(std::span<const Slot> slotMap, std::span<const float> opacitiesOfMapped);

    std::span<const Slot> slots;
    std::vector<float> opacities;  ///< [slot of a level]: 0 if not visible
    std::vector<float> ofMapped;   ///< [mapped slot]
    bool areAlike = false;         ///< no opacities were given
    std::size_t rising = 0;        ///< number of first opacities that never fall
};

/// Divides voxels into thin ones. Values are interpolated linearly along each axis. Inactive voxels
/// have no value, so voxels beside them and at the volume's end keep their own value, and a
/// homogeneous slab stays homogeneous. If next to nothing of a voxel would be visible at the
/// centres of its parts, each part gets the mean opacity within it, or the voxel stays as it is.
///
/// Mixed values are rounded to *levels*, which replace codes and are at most as many. Every value
/// of the volume is a level. As many evenly spaced levels as possible lie between neighbouring
/// values, most where values lie far apart for their size.
class ValueMixer {
  public:
    /// @param keepsLone  keep voxels as they are that would almost vanish
    ValueMixer(const Volume& volume, const Subdivision& parts, bool keepsLone = false);

    const Subdivision& parts() const { return parts_; }
    /// The volume for classification, without codes: code book and histogram are of levels, each
    /// possible one counted once.
    const Volume& levels() const { return levels_; }
    /// Returns the level of a code's own value.
    Code levelOf(Code code) const { return ownLevel_[code]; }

    /// Divides a block.
    /// @param mixed  [parts.within along u][parts.slices][parts.within along v]
    void mix(const MixWindow& window, const MixMap& map, std::span<BlockSlots> mixed) const;

    /// Calls use(part, n) for the parts of a block's voxel (0..7 each): voxel n of mixed[part].
    template <typename Use>
    void forPartsOf(const glm::ivec3& place, const Use& use) const;

  private:
    // Levels of uneven codes: between the values of the volume.
    struct TableLevels {
        struct Rung {
            double value;
            double half;  // half the distance to the next rung
            int level;
            int steps;  // number of levels up to the next rung
        };
        std::vector<Rung> rungs;     // values of the volume, in increasing order
        std::vector<double> ofCode;  // [kCodeCount]
        // First rung per bucket. A bucket has the numbers with the same leading bits.
        std::vector<int> starts;
        std::uint64_t least = 0;  // bits of the smallest magnitude other than 0
        int dropped = 0;          // number of low bits that buckets ignore
        std::size_t bucketOf(double value) const;
    };

    void makeEvenLevels(int lowest, int highest, VolumeData& levels);
    void makeTableLevels(const Volume& volume, VolumeData& levels);
    std::vector<int> levelsBetween(const std::vector<double>& values) const;
    void makeBuckets();
    int levelOfValue(double value) const;
    void keepSeen(const MixWindow& window, const MixMap& map, const VoxelMasks& places,
                  std::span<BlockSlots> mixed) const;

    double numberOf(Slot slot) const;
    int levelOfNumber(double number) const;
    double numberAt(const MixWindow& window, const glm::ivec3& place, const glm::dvec3& off) const;
    void showShares(const MixWindow& window, const MixMap& map, const glm::ivec3& place,
                    std::span<BlockSlots> mixed) const;
    Slot slotAsOpaque(const MixMap& map, int from, int to, double opacity) const;

    Subdivision parts_;
    bool keepsLone_;
    Volume levels_;
    EvenLevels even_;
    TableLevels table_;
    std::vector<Code> ownLevel_;  // [kCodeCount]
};

template <typename Use>
void ValueMixer::forPartsOf(const glm::ivec3& place, const Use& use) const {
    const glm::ivec3 per(parts_.slices, parts_.within, parts_.within);
    const glm::ivec3 first = place * per;
    for (int s = first.x; s < first.x + per.x; ++s) {
        for (int u = first.y; u < first.y + per.y; ++u) {
            for (int v = first.z; v < first.z + per.z; ++v) {
                const int part = (u / 8 * per.x + s / 8) * per.z + v / 8;
                use(std::size_t(part), std::size_t(64 * (s % 8) + 8 * (u % 8) + v % 8));
            }
        }
    }
}

/// Finds the blocks that may be visible if neighbours have a say. Mixed values lie between those of
/// a block and its neighbours and may be visible although the voxels themselves are clear. The same
/// happens beside a surface.
class MixedSight {
  public:
    /// @param slotMap     [kSlotCount]: 0 for the slots of clear levels
    /// @param byAllSides  neighbours along all axes count, divided or not; lists empty places, too
    MixedSight(const ValueMixer& mixer, std::span<const Slot> slotMap, bool byAllSides);

    /// Whether any voxel mixed within a window may be visible.
    bool canBeSeen(const MixWindow& window) const;
    /// Lists the blocks that may be visible, by u, then v, then slice. Tile slots are code + 1.
    /// @param histogram  of the volume's codes
    std::vector<CodeBlock> listBlocks(const CodeTree& codes, int sliceAxis,
                                      std::span<const std::uint64_t> histogram) const;

  private:
    int seenBefore(Code code) const { return before_[std::size_t(mixer_.levelOf(code))]; }
    bool isSeenBetween(Code low, Code high) const {
        return before_[std::size_t(mixer_.levelOf(high)) + 1] != seenBefore(low);
    }

    std::vector<Slot> seenCodes(std::span<const std::uint64_t> histogram) const;

    const ValueMixer& mixer_;
    bool byAllSides_;
    std::vector<int> before_;  // [slot]: number of visible levels before it
};

}  // namespace deltasplat
