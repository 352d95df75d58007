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

/// What levels become, and how opaque that is.
struct MixMap {
    /// @param slotMap           [kSlotCount]: what becomes of the slots of levels; must outlive
    /// this
    /// @param opacitiesOfMapped  [what becomes of them]: of a voxel, above 0 for all that can be
    /// seen;
    ///                           if there are none, they are alike
    MixMap(std::span<const Slot> slotMap, std::span<const float> opacitiesOfMapped);

    std::span<const Slot> slots;
    std::vector<float> opacities;  ///< [kSlotCount]: of the slots of levels, 0 of what is not seen
    std::vector<float> ofMapped;   ///< [what becomes of them]
    bool areAlike = false;         ///< whether no opacities were given
    std::size_t rising = 0;        ///< so many of the first opacities never fall
};

/// Divides voxels into thin ones. Their values are mixed from the voxels they lie between,
/// linearly along each axis. What is not active has no value: a voxel beside it keeps its own, and
/// so does one at the volume's end, so that a homogeneous slab stays what it is. Of a voxel of
/// which next to nothing would be seen in the middles of what it becomes, each of these is as
/// opaque as it is on average; or else the voxel stays as it is.
///
/// Mixed values are rounded to *levels*, at most as many as there are codes, and stand in for them.
/// Every value that the volume has is a level, and there are evenly spaced ones between each and
/// the next: as many as there is room for, most where values lie far apart for their size.
class ValueMixer {
  public:
    /// @param keepsLone  whether voxels stay as they are of which next to nothing would be seen
    ValueMixer(const Volume& volume, const Subdivision& parts, bool keepsLone = false);

    const Subdivision& parts() const { return parts_; }
    /// The volume as classification sees it: its code book and histogram are those of levels, of
    /// which each that can come about counts once. It has no codes.
    const Volume& levels() const { return levels_; }
    /// Returns the level that a code becomes where it is mixed with itself.
    Code levelOf(Code code) const { return ownLevel_[code]; }

    /// Mixes the blocks that a block becomes.
    /// @param mixed  [parts.within along u][parts.slices][parts.within along v]
    void mix(const MixWindow& window, const MixMap& map, std::span<BlockSlots> mixed) const;

    /// Calls use(part, n) for what the voxel at `place` (0..7 each) of a block becomes: voxel n of
    /// one of the blocks of `mixed`.
    template <typename Use>
    void forPartsOf(const glm::ivec3& place, const Use& use) const;

  private:
    // Levels of codes that are not even lie between values that the volume has.
    struct TableLevels {
        struct Rung {
            double value;
            double half;  // of the way to the next rung
            int level;
            int steps;  // levels up to the next rung
        };
        std::vector<Rung> rungs;     // values that the volume has, in increasing order
        std::vector<double> ofCode;  // [kCodeCount]
        // Where rungs of a bucket begin: of numbers with the same leading bits.
        std::vector<int> starts;
        std::uint64_t least = 0;  // magnitude that is not 0, its bits
        int dropped = 0;          // low bits
        std::size_t bucketOf(double value) const;
    };

    void makeEvenLevels(const Volume& volume, int lowest, int highest);
    void makeTableLevels(const Volume& volume);
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

/// Tells which blocks may be seen where a voxel's neighbours have a say: once voxels are divided,
/// mixed values lie between those of a block and of its neighbours, and may be seen where the
/// voxels themselves are clear; and so it is beside a surface.
class MixedSight {
  public:
    /// @param slotMap    [kSlotCount]: 0 for the slots of levels that are clear
    /// @param byAllSides  whether neighbours along all axes have a say, though voxels be divided
    ///                   along none; then places without any active voxel are listed, too
    MixedSight(const ValueMixer& mixer, std::span<const Slot> slotMap, bool byAllSides);

    /// Whether any voxel may be seen that is mixed within a window.
    bool canBeSeen(const MixWindow& window) const;
    /// Lists the blocks that may be seen, ordered by u, then v, then slice. Slots of tiles are
    /// code + 1.
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
    std::vector<int> before_;  // [kSlotCount]: how many levels before each can be seen
};

}  // namespace deltasplat
