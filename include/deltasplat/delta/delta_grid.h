// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "deltasplat/ingest/slot.h"
#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// OpenVDB Int32Grid of deltas; defined in src/formats/delta/delta_grid.h for its walkers.
struct DeltaTree;

/// A run of slices that can be read on its own: its first slice is a key slice.
struct Slab {
    int firstSlice = 0;  ///< index along the slice axis
    int sliceCount = 0;
    std::uint64_t visible = 0;  ///< voxels whose slot is not empty
    std::uint64_t deltas = 0;   ///< active voxels, key slice included
};

/// Slice-to-slice differences of a volume as a sparse grid in (slice, u, v) index space.
struct DeltaGrid {
    int sliceAxis = 2;        ///< volume axis along which slices are counted
    int keyInterval = 8;      ///< slices per slab, a multiple of 8; slabs start at multiples of it
    IndexBox box;             ///< the volume's box in (slice, u, v) order
    std::vector<Slab> slabs;  ///< in increasing order, covering `box`; none for an empty volume
    std::shared_ptr<const DeltaTree> tree;

    std::uint64_t visible() const;  ///< of all slabs
    std::uint64_t deltas() const;
};

struct DeltaOptions {
    int sliceAxis = 2;
    int keyInterval = 0;  ///< a multiple of 8; 0 = defaultKeyInterval of the volume's slices
    /// [kSlotCount] or empty: replaces each slot, so that codes that look alike make no deltas and
    /// invisible codes are empty. Entry 0 must be 0.
    std::span<const Slot> slotMap;
    /// Null, or a tree of voxels inactive in the volume, which get the slot kSlotCount + code.
    const CodeTree* inactive = nullptr;
};

/// Returns the default slices per slab: at least 128, and at most 16 slabs.
int defaultKeyInterval(int sliceCount);

/// Takes differences of consecutive slices. Linear in active voxels; deterministic; multi-threaded.
/// @throw Error(kUsage) if the key interval is not a positive multiple of 8
DeltaGrid makeDeltaGrid(const Volume& volume, const DeltaOptions& options);

/// Counts visible voxels and deltas without storing them (one slab over all slices).
struct SliceCounts {
    std::uint64_t visible = 0;
    std::uint64_t deltas = 0;
};
SliceCounts countDeltas(const Volume& volume, int sliceAxis, std::span<const Slot> slotMap = {});

/// Returns the counts of countDeltas per slice of the volume's box. All visible voxels of the first
/// slice are deltas. Empty for an empty volume.
/// @param slicesEach  >= 1: slices summed up per entry; the last entry sums up the rest
/// @throw Error(kFailed) if the entries do not fit into memory
std::vector<SliceCounts> countDeltasPerSlice(const Volume& volume, int sliceAxis,
                                             std::span<const Slot> slotMap = {},
                                             int slicesEach = 1);

}  // namespace deltasplat
