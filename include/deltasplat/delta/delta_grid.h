// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "deltasplat/ingest/slot.h"
#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// The OpenVDB Int32Grid of deltas; defined in src/formats/delta/delta_grid.h for the stage that
/// walks it.
struct DeltaTree;

/// A run of slices that can be read on its own, because its first slice is a key slice.
struct Slab {
    int firstSlice = 0;  ///< index along the slice axis
    int sliceCount = 0;
    std::uint64_t visible = 0;  ///< voxels whose slot is not empty
    std::uint64_t deltas = 0;   ///< active voxels, those of its key slice included
};

/// Slice-to-slice differences of a volume as a sparse grid in (slice, u, v) index space.
struct DeltaGrid {
    int sliceAxis = 2;        ///< volume axis along which slices are counted
    int keyInterval = 8;      ///< slices a slab, a multiple of 8; slabs start at multiples of 8
    IndexBox box;             ///< the volume's box in (slice, u, v) order
    std::vector<Slab> slabs;  ///< in increasing order, covering `box`; none for an empty volume
    std::shared_ptr<const DeltaTree> tree;

    std::uint64_t visible() const;  ///< visible voxels, all slabs together
    std::uint64_t deltas() const;   ///< deltas, all slabs together
};

/// How to take differences.
struct DeltaOptions {
    int sliceAxis = 2;
    int keyInterval = 0;  ///< a multiple of 8; 0 = defaultKeyInterval of the volume's slices
    /// [kSlotCount] or empty: the slot to use in place of each slot, so that codes which look alike
    /// make no deltas, and invisible ones are empty. Entry 0 must be 0.
    std::span<const Slot> slotMap;
    /// Null, or active where the volume is not: voxels that get the slot kSlotCount + their code.
    const CodeTree* inactive = nullptr;
};

/// Returns the slices a slab gets by default: at least 128, and never more than 16 slabs.
int defaultKeyInterval(int sliceCount);

/// Takes the differences of consecutive slices. Linear in the active voxels; deterministic;
/// multi-threaded.
/// @throw Error(kUsage) if the key interval is not a positive multiple of 8
DeltaGrid makeDeltaGrid(const Volume& volume, const DeltaOptions& options);

/// Counts visible voxels and deltas without storing them (one slab over all slices).
struct SliceCounts {
    std::uint64_t visible = 0;
    std::uint64_t deltas = 0;
};
SliceCounts countDeltas(const Volume& volume, int sliceAxis, std::span<const Slot> slotMap = {});

/// Returns what countDeltas counts, slice by slice of the volume's box: entry 0 is its first slice,
/// whose visible voxels are all deltas. Empty for an empty volume.
/// @param slicesEach  >= 1: each entry is the sum of so many slices, the last one of what is left
/// @throw Error(kFailed) if the entries do not fit into memory
std::vector<SliceCounts> countDeltasPerSlice(const Volume& volume, int sliceAxis,
                                             std::span<const Slot> slotMap = {},
                                             int slicesEach = 1);

}  // namespace deltasplat
