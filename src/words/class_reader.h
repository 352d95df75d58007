// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "deltasplat/ingest/slot.h"
#include "volume/class_ramps.h"
#include "volume/code_blocks.h"
#include "volume/code_math.h"
#include "words/packed_deltas.h"

namespace deltasplat {

/// Maps the voxels of blocks to classes or other slots.
class ClassReader {
  public:
    /// @param slotMap  [kSlotCount]; must outlive this object
    /// @param ramps    of the map, or null; must outlive this object
    ClassReader(std::span<const Slot> slotMap, const ClassRamps* ramps, int sliceAxis)
        : slotMap_(slotMap), ramps_(ramps), sliceAxis_(sliceAxis) {}

    std::span<const Slot> slotMap() const { return slotMap_; }
    int sliceAxis() const { return sliceAxis_; }

    /// @param out  [slice][u][v]
    /// @tparam T   ClassIndex or Slot, wide enough for the map
    template <typename T>
    void read(const CodeBlock& block, std::span<T, 512> out) const;

  private:
    bool readRamp(const CodeBlock& block, std::span<ClassIndex, 512> out) const;

    std::span<const Slot> slotMap_;
    const ClassRamps* ramps_;
    int sliceAxis_;
};

/// Decides which slot a voxel holds along the slice axis, by a table or, for many slots, by asking
/// `holds`. Numbers visible slots; others are 0. Thread-safe.
class SlotHolder {
  public:
    /// @param options  with `holds`; must outlive the holder
    SlotHolder(const Volume& volume, const PackOptions& options);

    /// Returns the number of each slot, [kSlotCount].
    std::span<const Slot> numberOfSlot() const { return numberOf_; }
    ClassIndex classOf(Slot number) const { return classOf_[number]; }
    /// Whether a voxel may hold another slot, of the same class or not.
    bool allows(Slot held, Slot slot) const {
        return held != 0 && slot != 0 && options_.holds(slots_[held], slots_[slot]);
    }
    /// Returns the slot number that a voxel holds next.
    Slot next(Slot held, Slot slot) const {
        return next_.empty() ? ask(held, slot)
                             : next_[std::size_t(held) * slots_.size() + std::size_t(slot)];
    }

  private:
    // Within a class there is nothing to tolerate, so the voxel takes its true slot.
    Slot ask(Slot held, Slot slot) const {
        return classOf_[held] != classOf_[slot] && allows(held, slot) ? held : slot;
    }

    const PackOptions& options_;
    std::vector<Slot> numberOf_;
    std::vector<Slot> slots_;          // [number]
    std::vector<ClassIndex> classOf_;  // [number]
    std::vector<std::uint16_t> next_;  // [held][slot], or empty
};

}  // namespace deltasplat
