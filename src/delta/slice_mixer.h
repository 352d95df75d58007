// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "delta/code_blocks.h"
#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// Puts slices between those of a volume: `perVoxel` thin ones for each, evenly spaced, the first
/// and the last as far from the voxels' middle as from the next slice's. Their values are mixed
/// from the two slices they lie between. What is not active has no value: a voxel beside it keeps
/// its own, and so does one at the volume's end, so that a homogeneous slab stays what it is.
///
/// Mixed values are rounded to *levels*, at most as many as there are codes, and stand in for them:
/// in steps of a code's own spacing or less where codes are evenly spaced, else to a share of the
/// value (about 2^-11 for values that span six decades).
class SliceMixer {
  public:
    /// @param perVoxel  1..kMostPerVoxel
    SliceMixer(const Volume& volume, int perVoxel);
    static constexpr int kMostPerVoxel = 8;

    int perVoxel() const { return perVoxel_; }
    /// The volume as classification sees it: its code book and histogram are those of levels, of
    /// which each that can come about counts once. It has no codes.
    const Volume& levels() const { return levels_; }
    /// Returns the level that a code becomes where it is mixed with itself.
    Code levelOf(Code code) const { return ownLevel_[code]; }

    /// What slices are mixed from: slots `[slice][u][v]` of a block and those of the slices before
    /// and behind it, empty where nothing lies there.
    struct Window {
        std::array<Slot, 64> before{};
        BlockSlots slots{};
        std::array<Slot, 64> behind{};
    };
    /// Mixes eight slices, the `part`-th of the perVoxel blocks that a block becomes: what
    /// `slotMap` [kSlotCount] has for the slots of their levels.
    void mix(const Window& window, int part, std::span<const Slot> slotMap,
             BlockSlots& mixed) const;

  private:
    // Levels of evenly spaced codes are evenly spaced themselves.
    struct EvenLevels {
        Code lowest = 0;
        int perCode = 0;  // of the steps from one code to the next; 0 if codes are not even
    };
    // Others are floating-point numbers of few significant bits, around one for 0.
    struct RoundedLevels {
        std::vector<double> values;  // [kCodeCount]: of codes
        int zero = 0;                // the level of 0
        int dropped = 0;             // low bits
        std::uint64_t first = 0;     // bits of the smallest magnitude, those dropped
        int most = 0;                // levels from 0 upwards or downwards
    };

    void makeEvenLevels(const Volume& volume, int lowest, int highest);
    void makeRoundedLevels(const Volume& volume);
    int levelOfValue(double value) const;
    double valueOfLevel(int level) const;
    void mixSlice(const Slot* here, const Slot* other, int weight, const Slot* slotMap,
                  Slot* mixed) const;
    Code mixCodes(Code here, Code other, int weight) const;

    int perVoxel_;
    Volume levels_;
    EvenLevels even_;
    RoundedLevels rounded_;
    std::vector<Code> ownLevel_;  // [kCodeCount]
};

}  // namespace deltasplat
