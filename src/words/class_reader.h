// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "deltasplat/ingest/slot.h"
#include "volume/class_index.h"
#include "volume/class_ramps.h"
#include "volume/code_blocks.h"

namespace deltasplat {

/// Reads what the voxels of blocks are under a map of slots.
class ClassReader {
  public:
    /// @param slotMap  [kSlotCount]; must outlive this, as must
    /// @param ramps    of the map; null: not known
    ClassReader(std::span<const Slot> slotMap, const ClassRamps* ramps, int sliceAxis)
        : slotMap_(slotMap), ramps_(ramps), sliceAxis_(sliceAxis) {}

    std::span<const Slot> slotMap() const { return slotMap_; }
    int sliceAxis() const { return sliceAxis_; }

    /// @param out  [slice][u][v]
    /// @tparam T   ClassIndex or Slot, which holds what the map has
    template <typename T>
    void read(const CodeBlock& block, std::span<T, 512> out) const;

  private:
    bool readRamp(const CodeBlock& block, std::span<ClassIndex, 512> out) const;

    std::span<const Slot> slotMap_;
    const ClassRamps* ramps_;
    int sliceAxis_;
};

}  // namespace deltasplat
